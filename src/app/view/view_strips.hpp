// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

/// Which quantities the viewer shows, in which order and in what words.
namespace versine::app {

struct ViewStrip {
  std::string id;         ///< the column of its file
  std::string title;      ///< "Level left"
  std::string note;       ///< "D1, 3-25 m"
  std::string unit;       ///< as shown
  std::string positive;   ///< sign convention: "+ up"
  std::string tab;        ///< of view_tabs()
  int digits = 1;         ///< behind the point
  std::string companion;  ///< a column drawn dashed beside it, on a scale of its own; empty: none
};

struct ViewTab {
  std::string id, title;
};
[[nodiscard]] const std::vector<ViewTab>& view_tabs();

/// Strips of the columns of a geometry.csv, in the order in which they are shown. `settings` is the job's [geometry].
[[nodiscard]] std::vector<ViewStrip> geometry_strips(const std::vector<std::string>& columns,
                                                     const nlohmann::ordered_json& settings);

}  // namespace versine::app

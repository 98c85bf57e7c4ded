// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "versine/app/config.hpp"
#include "versine/report/facts.hpp"

namespace versine::app {

/// The `[report]` table of a job.
struct ReportConfig {
  bool present = false;              ///< the job has the table: its result comes with a report
  std::vector<std::string> formats;  ///< of html, pdf, xlsx; empty: html
  std::string language = "en";
  report::Cover cover;
};
/// `with_cover`: the keys of a survey's cover (line, track, trolley, ...) besides formats, language and remarks.
void describe(ConfigVisitor& v, ReportConfig& c, bool with_cover);

}  // namespace versine::app

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "versine/core/error.hpp"

namespace versine::app {

/// What the viewer's page asks for. The server knows nothing of results: it guards the door and passes on.
struct ViewContent {
  std::function<std::string()> result_json;
  std::string crs;  ///< of the plan; empty until it is known
  /// Whether a job is writing the result, how far it is, and which generation of the result `result_json` is of.
  std::function<std::string()> progress_json;
  /// Values of every series at one place.
  std::function<std::string(double x)> values_json;
  /// Binary body of /api/series/{id}; nothing when there is no such series. `buckets` 0: every sample.
  std::function<std::optional<std::string>(const std::string& id, double from, double to, std::size_t buckets)> series;
  /// Binary body of /api/map/{part}: the lines and points of a plan; nothing when there is no such part.
  std::function<std::optional<std::string>(const std::string& part)> map;
  /// PNG of a window (least easting, northing, greatest) of the background in the result's CRS; nothing when there is
  /// no background, or none there.
  std::function<std::optional<std::string>(const std::array<double, 4>& window, int width, int height)> background;
  /// report.html of the result, where there is one.
  std::function<std::optional<std::string>()> report;
  /// Takes the reviewer's constraints; the error goes back to the page. Empty: there is nothing to review.
  std::function<Expected<void>(const std::string& json)> put_constraints;
  std::function<std::string()> constraints_json;  ///< what was decided before
  /// Places that a person marked: a JSON array, kept beside the result.
  std::function<std::string()> marks_json;
  std::function<Expected<void>(const std::string& json)> put_marks;
};

struct ViewAddress {
  int port = 0;       ///< 0: any free one
  std::string token;  ///< 64 hexadecimal digits; empty: made anew from 32 random bytes
};

/// Serves one open result on 127.0.0.1, and nowhere else. A request needs the server's own Host header, the token in
/// X-Versine-Token (the page and its assets, which hold no data, do not), the server's own Origin where one is sent,
/// and GET or HEAD; POST is allowed for constraints and marks alone. Paths are looked up in an exact map, never on
/// disk.
class ViewServer {
 public:
  [[nodiscard]] static Expected<ViewServer> start(ViewContent content, ViewAddress address = {});
  ViewServer(ViewServer&&) noexcept;
  ViewServer& operator=(ViewServer&&) = delete;
  ~ViewServer();  ///< stops serving

  /// The address to open, with the token in its fragment, which browsers send to nobody.
  [[nodiscard]] std::string url() const;
  [[nodiscard]] int port() const;
  [[nodiscard]] const std::string& token() const;
  /// Blocks until `stop` says true (asked five times a second).
  void wait(const std::function<bool()>& stop) const;

 private:
  struct Impl;
  explicit ViewServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A file of the page that was built into the program.
struct Asset {
  std::string_view gzip;
  std::string_view type;
};
/// By path, "/" for the page itself; empty in a build without the viewer.
[[nodiscard]] const std::map<std::string, Asset, std::less<>>& view_assets();

}  // namespace versine::app

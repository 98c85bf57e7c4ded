// SPDX-License-Identifier: Apache-2.0
#include "versine/app/constraints.hpp"

#include "versine/georef/georeference.hpp"

namespace versine::app {

void describe(ConfigVisitor& v, std::vector<georef::Constraint>& constraints) {
  v.tables<georef::Constraint>(
      "constraint", "What a reviewer decided about a stretch of time; also in a file of its own.", constraints,
      [](ConfigVisitor& t, georef::Constraint& k) {
        t.value("recording", k.recording, {.doc = "Name of the recording; none: every recording."});
        double from = static_cast<double>(k.from.ns) / 1e9, to = static_cast<double>(k.to.ns) / 1e9;  // as written
        t.value("from_s", from, {.doc = "Beginning, in the recording's time.", .unit = "s", .required = true});
        t.value("to_s", to, {.doc = "End.", .unit = "s", .required = true});
        k.from = Time::from_seconds(from), k.to = Time::from_seconds(to);
        t.value("tracks", k.tracks,
                {.doc = "The vehicle was on these only: tracks, or lines of the map.",
                 .required = true,
                 .example = "[\"A1\", \"X1ab\"]"});
        t.value("excluded", k.excluded, {.doc = "It was on none of them."});
        t.value("comment", k.comment, {.doc = "For people."});
      });
}

Expected<std::vector<georef::Constraint>> read_constraints(const std::filesystem::path& path) {
  std::vector<georef::Constraint> constraints;
  if (auto read = read_config(path, [&](ConfigVisitor& v) { describe(v, constraints); }); !read) {
    return tl::unexpected(read.error());
  }
  if (auto good = georef::check(constraints); !good) {
    Error error = good.error();
    error.file = path.string();
    return tl::unexpected(error);
  }
  return constraints;
}

}  // namespace versine::app

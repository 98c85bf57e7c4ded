// SPDX-License-Identifier: Apache-2.0
#include "versine/app/gnss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>

#include "gnss_engine.hpp"
#include "versine/gnss/fixed_sigma.hpp"

namespace versine::app {

using gnss::Direction;

Expected<GnssResult> process_gnss(const GnssProcessing& g, Progress& progress, Log& log) {
  const auto program = gnss_files::need_program({"rnx2rtkp"}, "install RTKLIB (Debian: apt install rtklib)");
  if (!program) return tl::unexpected(program.error());
  const gnss_files::Workspace workspace;
  const auto files = gnss_files::prepare(g, workspace, progress);
  if (!files) return tl::unexpected(files.error());
  if (auto ok = gnss_files::check(g, *files); !ok) return tl::unexpected(ok.error());
  GnssEngine engine(g, *files, workspace, *program, progress);
  const bool relative = g.options.positioning != gnss::Positioning::single;
  if (relative) {
    if (auto ok = engine.check_base(); !ok) return tl::unexpected(ok.error());
  }

  GnssResult out;
  for (const gnss_files::File& f : files->rover) out.epochs += f.scan.epochs;
  out.configuration = gnss::rtklib_configuration(engine.options(), g.direction);
  const bool both = relative && g.direction == Direction::combined;
  auto forward = std::async(both ? std::launch::async : std::launch::deferred,
                            [&] { return engine.solve(Direction::forward, 0.05, 0.5); });
  auto backward = std::async(both ? std::launch::async : std::launch::deferred,
                             [&] { return engine.solve(Direction::backward, 0.05, 0.5); });
  auto wanted = engine.solve(relative ? g.direction : Direction::forward, 0.05, 1.0);
  if (!wanted) return tl::unexpected(wanted.error());
  out.series = std::move(*wanted);
  std::sort(out.series.samples.begin(), out.series.samples.end(),
            [](const auto& a, const auto& b) { return a.time < b.time; });
  if (both) {
    const auto f = forward.get(), b = backward.get();
    if (!f) return tl::unexpected(f.error());
    if (!b) return tl::unexpected(b.error());
    auto agreement = gnss::compare_directions(std::move(out.series), gnss::with_steady_sigmas(*f),
                                              gnss::with_steady_sigmas(*b), g.agreement);
    out.series = std::move(agreement.series);
    out.fixed = agreement.fixed;
    out.confirmed = agreement.confirmed;
    out.doubted = agreement.doubted;
    out.record.findings = std::move(agreement.findings);
  } else {
    for (const auto& s : out.series) out.fixed += s.fix == sensors::FixType::fixed;
  }
  out.series = gnss::with_steady_sigmas(std::move(out.series));
  if (out.series.size() < out.epochs) {
    out.record.warnings.push_back(fmt::format("{} of {} epochs have a position", out.series.size(), out.epochs));
  }
  for (const auto& w : out.record.warnings) log.warn(w);
  return out;
}

}  // namespace versine::app

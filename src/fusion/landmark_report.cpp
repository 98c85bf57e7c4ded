// SPDX-License-Identifier: Apache-2.0
#include "landmark_report.hpp"

#include <fmt/format.h>

namespace versine::fusion::landmark {

Expected<void> report_landmarks(const LandmarkInput& in, const Placement& p, const LandmarkOptions& o,
                                RunRecord& record) {
  std::size_t used = 0, unchecked = 0;
  for (std::size_t i = 0; i < p.ties.size(); ++i) {
    const auto& l = (*in.landmarks)[p.ties[i].landmark];
    if (p.fits[i].used) {
      ++used;
      unchecked += p.fits[i].redundancy < 0.01 ? 1 : 0;
      continue;
    }
    record.rejections.push_back({.sensor = "landmark",
                                 .time = l.time,
                                 .reason = "contradicts the others",
                                 .normalized = p.fits[i].worst(),
                                 .threshold = o.gate});
  }
  if (used < 2 || 2 * used < p.ties.size()) {
    return fail({.field = "landmarks",
                 .found = fmt::format("{} of {} landmarks that fit each other", used, p.ties.size()),
                 .expected = "most of them, within the sigmas given",
                 .advice =
                     "check coordinate system, height datum, units and lever arm of the landmarks, the odometer's "
                     "scale, a heading given for the start, and whether all sigmas are as small as stated"});
  }
  if (unchecked > 0) {
    record.warnings.push_back(
        fmt::format("{} of {} landmarks are checked by nothing else: an error in one goes into "
                    "the result in full. One more landmark would check them.",
                    unchecked, used));
  }
  return {};
}

void warn_model(const std::vector<Stretch>& stretches, const LandmarkOptions& o, RunRecord& record) {
  std::size_t count = 0;
  const Stretch* worst = nullptr;
  for (const auto& s : stretches) {
    if (!(s.model_error > o.model_error_limit)) continue;
    ++count;
    if (worst == nullptr || s.model_error > worst->model_error) worst = &s;
  }
  if (worst == nullptr) return;
  record.warnings.push_back(fmt::format(
      "the reduced model may be off by more than {:.1f} mm (1 sigma) in {} of {} stretches between landmarks; at worst "
      "{:.2f} mm between {:.0f} and {:.0f} m from the start, with {:.0f} mrad of cant and {:.1f} deg of turn. Its "
      "sigmas include this. Closer landmarks, better calibrated mounting angles, or the aided INS cure it.",
      o.model_error_limit / units::mm, count, stretches.size(), worst->model_error / units::mm, worst->begin,
      worst->begin + worst->length, worst->cant_range * 1e3, worst->heading_range / units::deg));
}

void note_observability(const Observability& o, Time from, Time to, RunRecord& record) {
  const auto note = [&](std::string detail) {
    record.findings.push_back({.sensor = "landmark dead reckoning",
                               .kind = "observability",
                               .from = from,
                               .to = to,
                               .action = Finding::Action::noted,
                               .detail = std::move(detail)});
  };
  note(fmt::format(
      "rank {} of {} vertical and {} of {} level states (condition {:.3g} and {:.3g}); by this run's landmarks "
      "alone rank {} and {} (condition {:.3g} and {:.3g})",
      o.vertical_rank, vertical::size, o.level_rank, level::size, o.vertical_condition, o.level_condition,
      o.run_vertical_rank, o.run_level_rank, o.run_vertical_condition, o.run_level_condition));
  for (const auto& sentence : o.verdict) note(sentence);
}

}  // namespace versine::fusion::landmark

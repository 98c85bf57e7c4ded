// SPDX-License-Identifier: Apache-2.0
#include "versine/io/fastenings_csv.hpp"

#include <map>

#include "text_output.hpp"

namespace versine::io {
namespace {

struct Side {
  const char *direction, *rail;
  const track::FasteningPlan* plan;
};

std::array<Side, 4> parts_of(const FasteningPlans& p) {
  return {Side{"lateral", "left", &p.lateral[0]}, Side{"lateral", "right", &p.lateral[1]},
          Side{"vertical", "left", &p.vertical[0]}, Side{"vertical", "right", &p.vertical[1]}};
}

}  // namespace

Expected<void> write_fastenings_csv(const std::filesystem::path& path, const FasteningPlans& p) {
  TextOutput out(path);
  out.text(
      "# lateral: positive right in the direction of increasing mileage; vertical: positive up\n# measured and left: "
      "deviation from design; move: of the rail at this fastening\nfastening,distance_m,mileage_m");
  for (const Side& part : parts_of(p)) {
    if (part.plan->steps.empty()) continue;
    for (const char* what : {"measured", "move", "left"}) out.print(",{}_{}_{}_mm", part.direction, part.rail, what);
  }
  out.end_line();
  for (std::size_t i = 0; i < p.at.size(); ++i) {
    out.print("{},{:.3f},{:.3f}", i + 1, p.at.mileage[i], p.at.posted_at(p.at.mileage[i]));
    for (const Side& part : parts_of(p)) {
      if (part.plan->steps.empty()) continue;
      const double before = p.at.at(std::string("deviation_") + part.direction + "_" + part.rail).value[i];
      const double after = part.plan->after[i];
      for (const double x : {before, after - before, after}) {
        out.text(",");
        out.number(1e3 * x, 2);
      }
    }
    out.end_line();
  }
  return out.close();
}

Expected<void> write_parts_csv(const std::filesystem::path& path, const FasteningPlans& p, double lateral_step,
                               double vertical_step) {
  TextOutput out(path);
  out.text("direction,rail,move_mm,fastenings\n");
  for (const Side& part : parts_of(p)) {
    const double step = part.direction[0] == 'l' ? lateral_step : vertical_step;
    std::map<int, std::size_t> count;
    for (const int s : part.plan->steps) ++count[s];
    for (const auto& [steps, n] : count) {
      if (steps != 0) out.print("{},{},{:+.2f},{}\n", part.direction, part.rail, 1e3 * step * steps, n);
    }
  }
  return out.close();
}

}  // namespace versine::io

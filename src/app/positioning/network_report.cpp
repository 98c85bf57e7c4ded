// SPDX-License-Identifier: Apache-2.0
#include "network_report.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "versine/core/units.hpp"

namespace versine::app {

Expected<void> write_network_points(const std::filesystem::path& path, const geodesy::LocalFrame& frame,
                                    const stationing::NetworkResult& network) {
  std::ofstream points(path);
  points << "name,latitude_deg,longitude_deg,height_m,sigma_north_mm,sigma_east_mm,sigma_down_mm,offset_north_mm,"
            "offset_east_mm,offset_down_mm,control_test,moved\n";
  for (const auto& p : network.points) {
    const auto g = frame.to_geodetic(p.position);
    const Eigen::Vector3d s = p.covariance.diagonal().cwiseMax(0.0).cwiseSqrt() * 1e3;
    const std::string offset =
        p.offset ? fmt::format("{:.3f},{:.3f},{:.3f}", p.offset->x() * 1e3, p.offset->y() * 1e3, p.offset->z() * 1e3)
                 : ",,";
    points << fmt::format("{},{:.12f},{:.12f},{:.6f},{:.3f},{:.3f},{:.3f},{},{:.2f},{}\n", p.name,
                          g.latitude / units::deg, g.longitude / units::deg, g.height, s.x(), s.y(), s.z(), offset,
                          p.control_test, p.moved ? 1 : 0);
  }
  if (points.flush()) return {};
  return fail({.file = path.string(),
               .found = "the file could not be written",
               .expected = "a folder that can be written",
               .advice = "is the disk full? Choose another folder with --output"});
}

std::string network_summary_json(const stationing::NetworkResult& network) {
  nlohmann::ordered_json moved = nlohmann::ordered_json::array();
  for (const auto& p : network.points) {
    if (p.moved) moved.push_back(p.name);
  }
  return nlohmann::ordered_json{{"sigma0", network.sigma0},
                                {"redundancy", network.redundancy},
                                {"points", network.points.size()},
                                {"moved", moved}}
      .dump();
}

}  // namespace versine::app

// SPDX-License-Identifier: Apache-2.0
// Positioning on real recordings: the tables of docs/total-station.md and docs/gnss.md.
// versine_positioning_real DATA_FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "versine/app/gnss.hpp"
#include "versine/core/process.hpp"
#include "versine/geodesy/ellipsoid.hpp"
#include "versine/io/input_stream.hpp"
#include "versine/io/read_recording.hpp"
#include "versine/io/total_station_formats.hpp"
#include "versine/stationing/free_station.hpp"
#include "versine/stationing/network_adjustment.hpp"

using namespace versine;
namespace fs = std::filesystem;

namespace {

/// An error ends the program with its message (main).
struct Failure {
  std::string message;
};

template <class T>
const T& need(const Expected<T>& e) {
  if (!e) throw Failure{e.error().message()};
  return *e;
}

/// The network's own figures hold for the mean of all sets; instruments and prisms are forced centred.
const stationing::Instrument leica{
    .angle_sigma = 1.0 * units::mgon, .distance_sigma = 1.5e-3, .distance_sigma_ppm = 0.0, .target_sigma = 0.0};

void total_station(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  const auto book = io::parse_field_book(text.str(), path.string());
  std::vector<stationing::ReducedStation> stations;
  double collimation = 0.0, index = 0.0;
  std::size_t readings = 0;
  for (const auto& s : need(book).stationings) {
    stations.push_back(need(stationing::reduce(s, leica)));
    collimation = std::max(collimation, std::abs(*stations.back().collimation));
    index = std::max(index, std::abs(*stations.back().index_error));
    readings += s.sightings.size();
    for (auto& t : stations.back().targets) t.direction_sigma = t.zenith_sigma = 1.0 * units::mgon;
  }
  std::printf(
      "### Leica network\n\n%zu stations, %zu readings; largest collimation %.2f mgon, index error %.2f mgon\n\n",
      stations.size(), readings, collimation / units::mgon, index / units::mgon);
  stationing::NetworkOptions options{.tilt_sigma = 0.01 * units::arcsec, .free = true, .snoop = false};
  const auto all = stationing::adjust_network(stations, {}, leica, options);
  options.snoop = true;
  const auto clean = stationing::adjust_network(stations, {}, leica, options);
  std::printf("| free adjustment | sigma0 | redundancy | sightings |\n|---|---|---|---|\n");
  std::printf("| all | %.3f | %d | %zu |\n", need(all).sigma0, all->redundancy, all->residuals.size());
  std::size_t used = 0;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const auto& r : need(clean).residuals) {
    used += r.used;
    if (r.used) squares += r.residual.cwiseAbs2();
  }
  const Eigen::Vector3d rms = (squares / double(used)).cwiseSqrt() * 1e3;
  std::printf("| without what fails its test | %.3f | %d | %zu |\n| given with the data | 0.978 | | |\n\n",
              clean->sigma0, clean->redundancy, used);
  std::printf("Residuals RMS across, up, along: %.2f, %.2f, %.2f mm. Left out:", rms.x(), rms.y(), rms.z());
  for (const auto& r : clean->residuals) {
    if (!r.used) std::printf(" %s-%s", r.station.c_str(), r.point.c_str());
  }
  std::printf(
      "\n\n| station alone on the adjusted points | targets, left out | north, east, down, mm | own sigma, mm |\n"
      "|---|---|---|---|\n");
  std::vector<stationing::ControlPoint> points;
  for (const auto& p : clean->points) points.push_back({p.name, p.position, p.covariance});
  const auto control = stationing::ControlNetwork::create(points);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto r = stationing::free_station(stations[i], need(control), leica, {.tilt_sigma = 1.0 * units::arcsec});
    const Eigen::Vector3d e = (need(r).position - clean->stations[i].position) * 1e3;
    const Eigen::Vector3d s = r->covariance.diagonal().head<3>().cwiseSqrt() * 1e3;
    std::printf("| %s | %zu, %zu | %.2f, %.2f, %.2f | %.2f, %.2f, %.2f |\n", r->name.c_str(), r->targets.size(),
                r->excluded.size(), e.x(), e.y(), e.z(), s.x(), s.y(), s.z());
  }
}

struct Set {
  std::string name;
  app::GnssProcessing job;
  std::optional<Eigen::Vector3d> truth;  ///< of a rover that stands, ECEF, m
};

Eigen::Vector3d ecef(const sensors::GnssSample& s) {
  return geodesy::wgs84.to_ecef(s.position).r;
}

struct Agreement {
  std::size_t epochs = 0,
              same = 0;  ///< of RTKLIB's epochs: same time and fix, and place within 0.3 mm (a last digit)
  double largest = 0.0;  ///< m
};

/// RTKLIB's own program with the configuration that the result folder holds (rtklib.conf), against the job's result
/// without the check of both directions.
Agreement against_rtklib(const Set& set) {
  app::GnssProcessing g = set.job;
  g.agreement.distance = 1e9;
  SilentProgress progress;
  SilentLog log;
  const auto ours = app::process_gnss(g, progress, log);
  const auto program = find_program("rnx2rtkp");
  if (!program) throw Failure{"rnx2rtkp is not installed"};
  const fs::path folder = fs::temp_directory_path() / "versine-positioning-real";
  fs::create_directories(folder);
  gnss::Options options = g.options;
  options.base_ecef = g.base_ecef;
  std::ofstream(folder / "own.conf") << gnss::rtklib_configuration(options, gnss::Direction::combined);
  std::vector<std::string> arguments{"-k", (folder / "own.conf").string(), "-o", (folder / "own.pos").string()};
  int number = 0;
  for (const auto* group : {&g.rover, &g.base, &g.navigation}) {
    for (const auto& f : *group) {
      arguments.push_back((folder / std::to_string(number++)).string());
      std::ofstream(arguments.back(), std::ios::binary) << need(io::read_text(f.path));
    }
  }
  need(run_process(*program, arguments, [](std::string_view) { return true; }));
  const auto own = io::read_gnss({.table = {.path = folder / "own.pos"}, .format = io::GnssFile::Format::rtklib});
  Agreement a{.epochs = need(own).series.size()};
  for (const auto& s : need(ours).series) {
    const std::size_t i = own->series.lower_bound(s.time);
    if (i == own->series.size() || own->series[i].time != s.time) continue;
    const double apart = (ecef(own->series[i]) - ecef(s)).norm();
    a.same += own->series[i].fix == s.fix && apart < 0.3e-3;
    a.largest = std::max(a.largest, apart);
  }
  fs::remove_all(folder);
  return a;
}

void gnss_sets(const fs::path& data) {
  const auto in = [&](const char* name) { return app::InputPath{data / name, name}; };
  std::vector<Set> sets(3);
  sets[0] = {.name = "Spirent, static, 2 km, GPS and Galileo"};
  sets[0].job.rover = {in("spirent-static-2km/Rover-static-2km-east_MO_Spirent.obs.zst")};
  sets[0].job.base = {in("spirent-static-2km/Base-static_MO_Spirent.obs.zst")};
  sets[0].job.navigation = {in("spirent-static-2km/RINEX_GN_Spirent.23N.zst"),
                            in("spirent-static-2km/RINEX_EN_Spirent.23L.zst")};
  sets[0].job.base_ecef = Eigen::Vector3d(4157177.06580187, 671230.476590636, 4774767.03105544);
  sets[0].job.options.systems = {"GPS", "Galileo"};
  sets[0].truth = Eigen::Vector3d(4156857.1195929, 673209.028774142, 4774767.03105544);
  sets[1] = {.name = "GEONET, static, 3.3 km, GPS"};
  sets[1].job.rover = {in("geonet-0759-3040/07590920.05o")};
  sets[1].job.base = {in("geonet-0759-3040/30400920.05o")};
  sets[1].job.navigation = {in("geonet-0759-3040/07590920.05n")};
  sets[1].job.base_ecef = Eigen::Vector3d(-3978241.958, 3382840.234, 3649900.853);
  sets[1].job.options.systems = {"GPS"};
  sets[1].truth = Eigen::Vector3d(-3976219.1868, 3382371.6036, 3652511.1412);  // mean of RTKLIB as documented
  sets[2] = {.name = "Fujisawa, moving, 5.4 km"};
  sets[2].job.rover = {in("moving-rover-fujisawa/SEPT265G.21O.zst")};
  sets[2].job.base = {in("moving-rover-fujisawa/3034265G.21O.zst")};
  sets[2].job.navigation = {in("moving-rover-fujisawa/SEPT2650.21P.zst")};
  sets[2].job.base_ecef = Eigen::Vector3d(-3959400.631, 3385704.533, 3667523.111);
  std::printf(
      "\n### GNSS\n\n| set | epochs | fixed | confirmed | doubted | mean off (x, y, z; 3-D), mm | RMS (x, y, z), mm | "
      "own sigma (n, e, d), mm | equal to rnx2rtkp, largest difference, mm "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  for (Set& set : sets) {
    SilentProgress progress;
    SilentLog log;
    const auto r = app::process_gnss(set.job, progress, log);
    std::printf("| %s | %zu | %zu | %zu | %zu | ", set.name.c_str(), need(r).epochs, r->fixed, r->confirmed,
                r->doubted);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), squares = mean, sigma = mean;
    const double n = double(r->series.size());
    for (const auto& s : r->series) {
      const Eigen::Vector3d e = set.truth ? Eigen::Vector3d(1e3 * (ecef(s) - *set.truth)) : Eigen::Vector3d::Zero();
      mean += e / n, squares += e.cwiseAbs2() / n, sigma += 1e3 * s.sigma_ned / n;
    }
    if (set.truth) {
      std::printf("%.1f, %.1f, %.1f; %.1f | %.1f, %.1f, %.1f | ", mean.x(), mean.y(), mean.z(), mean.norm(),
                  std::sqrt(squares.x()), std::sqrt(squares.y()), std::sqrt(squares.z()));
    } else {
      std::printf("no truth | | ");
    }
    const Agreement a = against_rtklib(set);
    std::printf("%.1f, %.1f, %.1f | %zu of %zu, %.2f |\n", sigma.x(), sigma.y(), sigma.z(), a.same, a.epochs,
                1e3 * a.largest);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::printf("versine_positioning_real DATA_FOLDER\n"), 2;
  try {
    total_station(fs::path(argv[1]) / "total-station" / "network.GSI");
    gnss_sets(fs::path(argv[1]) / "rinex");
  } catch (const Failure& f) {
    std::fprintf(stderr, "%s\n", f.message.c_str());
    return 1;
  }
  return 0;
}

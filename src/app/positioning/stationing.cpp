// SPDX-License-Identifier: Apache-2.0
#include "versine/app/stationing.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "station_landmarks.hpp"
#include "versine/geodesy/attitude.hpp"
#include "versine/io/total_station_readings.hpp"

namespace versine::app {
namespace {

using stationing::StationResult;

void note_results(StationingOutcome& out) {
  for (const auto& f : out.run.failed) {
    out.record.rejections.push_back({.sensor = "total station",
                                     .time = f.from.value_or(Time{}),
                                     .reason = fmt::format("{}: {}", f.name, f.error.message())});
  }
  std::map<std::string, std::vector<std::string>> told;  // what many stations share is told once
  for (const StationResult& s : out.run.stations) {
    for (const auto& w : s.warnings) told[w].push_back(s.name);
    for (const auto& e : s.excluded) {
      out.record.rejections.push_back(
          {.sensor = "total station",
           .time = s.from.value_or(Time{}),
           .reason = fmt::format("station {}, point {}: {}{}", s.name, e.point, to_string(e.reason),
                                 e.is.empty() ? "" : ", it is " + e.is),
           .normalized = std::sqrt(e.test)});
    }
    if (s.geometry.grade == stationing::GeometryVerdict::Grade::poor) {
      out.record.warnings.push_back(
          fmt::format("station {}: poor geometry: {}", s.name, fmt::join(s.geometry.remarks, "; ")));
    }
  }
  for (const auto& [text, stations] : told) {
    out.record.warnings.push_back(stations.size() == 1 ? fmt::format("station {}: {}", stations.front(), text)
                                                       : fmt::format("{} stations ({} to {}): {}", stations.size(),
                                                                     stations.front(), stations.back(), text));
  }
  for (const auto& m : out.run.moved) {
    out.record.warnings.push_back(
        fmt::format("control point {} has moved since its survey by {:.1f} mm north, {:.1f} mm east, {:.1f} mm down "
                    "(stations {}); it "
                    "was left out",
                    m.name, m.offset.x() * 1e3, m.offset.y() * 1e3, m.offset.z() * 1e3, fmt::join(m.stations, ", ")));
  }
}

Expected<std::vector<io::ControlEntry>> read_control(const StationingProcessing& p) {
  std::vector<io::ControlEntry> all;
  for (const InputPath& input : p.control) {
    io::ControlFile file{.table = {.path = input.path}, .frame = {.crs = p.crs}, .sigma = p.control_sigma};
    if (p.origin) {
      file.frame.origin = geodesy::Geodetic{p.origin->x() * units::deg, p.origin->y() * units::deg, p.origin->z()};
    }
    auto list = io::read_control_points(file);
    if (!list) return tl::unexpected(list.error());
    all.insert(all.end(), list->begin(), list->end());
  }
  if (all.empty()) {
    return fail({.field = "total_station.control",
                 .found = "no control points",
                 .expected = "a list of control points",
                 .advice = "name the file of the control network"});
  }
  return all;
}

/// Face I alone holds the instrument's axis errors: somebody must have said that they are known.
Expected<void> check_faces(const std::vector<stationing::Stationing>& stationings, const StationingProcessing& p) {
  if (p.instrument.one_face || p.instrument.collimation != 0.0 || p.instrument.index_error != 0.0) return {};
  for (const auto& s : stationings) {
    const auto two = [](const stationing::Sighting& r) { return r.face == stationing::Face::two; };
    if (s.sightings.empty() || std::any_of(s.sightings.begin(), s.sightings.end(), two)) continue;
    return fail({.file = p.readings.front().written,
                 .line = s.sightings.front().line,
                 .field = "station " + s.name,
                 .found = "readings in face I only",
                 .expected = "face II too, which cancels collimation and index error",
                 .advice =
                     "measure face II; or give collimation_arcsec and index_error_arcsec of a calibration; or, if "
                     "the instrument corrects them itself, say one_face = true"});
  }
  return {};
}

}  // namespace

StationingOutcome compute_landmarks(std::vector<stationing::Stationing> stationings, stationing::ControlNetwork network,
                                    const geodesy::LocalFrame& frame, const StationingProcessing& p,
                                    Progress& progress) {
  StationingOutcome out;
  out.frame = frame;
  out.network = std::move(network);
  const bool beside = p.arrangement == StationingProcessing::Arrangement::beside;
  PrismStops stops;
  for (auto& s : stationings) {
    if (beside) stops[s.name] = take_prism(s, p.prism);
    if (auto r = stationing::reduce(s, p.instrument)) out.reduced.push_back(std::move(*r));
  }
  out.run = stationing::compute_stations(stationings, out.network, p.instrument, p.options, progress);
  out.landmarks = beside ? prism_landmarks(out, stops, p) : station_landmarks(out, p);
  note_results(out);
  return out;
}

Expected<StationingOutcome> process_stationing(const StationingProcessing& p, Progress& progress, Log& log,
                                               const std::function<void(std::span<stationing::Stationing>)>& prepare) {
  const auto control = read_control(p);
  if (!control) return tl::unexpected(control.error());
  const geodesy::LocalFrame frame((*control)[control->size() / 2].position);
  std::vector<stationing::ControlPoint> points;
  for (const auto& e : *control) {
    const Eigen::Matrix3d to_m = frame.rotation_from(e.position);
    points.push_back(
        {e.name, frame.to_ned(e.position), to_m * e.sigma_ned.cwiseAbs2().asDiagonal() * to_m.transpose()});
  }
  auto network = stationing::ControlNetwork::create(std::move(points));
  if (!network) {
    Error error = network.error();
    error.file = p.control.front().written;
    return fail(std::move(error));
  }
  std::vector<stationing::Stationing> stationings;
  std::vector<std::string> warnings;
  for (const InputPath& input : p.readings) {
    io::TableFile file{.path = input.path, .columns = p.columns};
    file.clock.scale = p.time_scale;
    auto book = io::read_total_station(file);
    if (!book) return tl::unexpected(book.error());
    stationings.insert(stationings.end(), book->stationings.begin(), book->stationings.end());
    warnings.insert(warnings.end(), book->warnings.begin(), book->warnings.end());
  }
  if (auto fine = check_faces(stationings, p); !fine) return tl::unexpected(fine.error());
  if (prepare) prepare(stationings);
  for (const auto& finding : stationing::check(*network)) warnings.push_back("control list: " + finding.text);
  auto out = compute_landmarks(std::move(stationings), std::move(*network), frame, p, progress);
  out.record.warnings.insert(out.record.warnings.begin(), warnings.begin(), warnings.end());
  for (const auto& w : out.record.warnings) log.warn(w);
  if (out.run.stations.empty()) {
    if (out.run.failed.empty()) {
      return fail({.field = "total_station.readings",
                   .found = "no stations",
                   .expected = "readings of at least one station",
                   .advice = "name the file of readings"});
    }
    Error error = out.run.failed.front().error;
    if (error.file.empty()) error.file = p.readings.front().written;
    return fail(std::move(error));
  }
  return out;
}

std::vector<Rejection> require_standstill(std::vector<sensors::LandmarkSample>& landmarks,
                                          const std::vector<inertial::Interval>& standstills) {
  std::vector<Rejection> rejections;
  std::erase_if(landmarks, [&](const sensors::LandmarkSample& l) {
    const bool standing = std::any_of(standstills.begin(), standstills.end(), [&](const inertial::Interval& s) {
      return s.contains(l.time) &&
             (l.to - l.from <= Duration::from_seconds(0.1) ||
              // the ends of a standstill are trimmed by its detection
              (s.from <= l.from + Duration::from_seconds(1.5) && l.to <= s.to + Duration::from_seconds(1.5)));
    });
    if (!standing)
      rejections.push_back({.sensor = "total station", .time = l.time, .reason = l.name + ": not standing"});
    return !standing;
  });
  return rejections;
}

BodyPose to_body(const sensors::LandmarkSample& l, const Eigen::Vector3d& l_bs_b, const Eigen::Quaterniond& q_bs,
                 double lever_sigma, double mounting_sigma) {
  BodyPose b;
  const Eigen::Quaterniond q_ns = l.q_ns.value_or(Eigen::Quaterniond::Identity());
  b.q_nb = (q_ns * q_bs.conjugate()).normalized();
  const Eigen::Vector3d arm = b.q_nb * l_bs_b;
  b.position = geodesy::wgs84.displaced(l.position, -arm);
  b.attitude_covariance = l.attitude_covariance + mounting_sigma * mounting_sigma * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d lever = geodesy::skew(arm);
  b.covariance = l.covariance + lever * b.attitude_covariance * lever.transpose() +
                 lever_sigma * lever_sigma * Eigen::Matrix3d::Identity();
  return b;
}

}  // namespace versine::app

// SPDX-License-Identifier: Apache-2.0
#include "scenario.hpp"

#include "versine/core/units.hpp"
#include "versine/geodesy/ellipsoid.hpp"

namespace versine::study {

using namespace units;

namespace {
constexpr const char* crs = "+proj=tmerc +lat_0=0 +lon_0=9 +k=1 +x_0=500000 +ellps=GRS80 +units=m";
}  // namespace

simulation::Scenario jiang_trolley(double heading) {
  simulation::Scenario s;
  s.track.alignment.crs = crs;
  s.track.height = 400.0;
  simulation::ImuModel imu;
  imu.errors = sensors::find_imu_grade("rlg-jiang")->errors;
  s.equipment.imu = imu;
  simulation::OdometerModel odometer;
  odometer.output = simulation::OdometerModel::Output::distance;
  odometer.rate = 50.0;
  odometer.quantum = 0.1 * mm;
  odometer.scale = 1e-3;
  odometer.scale_walk = 8e-6;
  s.equipment.odometers.push_back(odometer);
  simulation::TotalStationModel station;
  station.every = 60.0;
  s.equipment.total_station = station;
  s.track.alignment.horizontal = *design::HorizontalAxis::chain({500000.0, 5250000.0, heading}, {design::line(400.0)});
  return s;
}

fusion::LandmarkOptions options_for(const simulation::Scenario& s) {
  fusion::LandmarkOptions o;
  o.gyro = s.equipment.imu->errors.gyro;
  o.levelling_sigma = s.equipment.imu->errors.accelerometer.bias / 9.81;
  o.lever_odometer = {0.5 * (s.trolley.front_x + s.trolley.rear_x), s.trolley.reference_y, s.trolley.contact_z};
  o.lever_landmark = s.equipment.total_station->place;
  o.scale_sigma = s.equipment.odometers[0].scale;
  o.odometer_resolution = s.equipment.odometers[0].quantum;
  o.path_walk = 0.01 * mm;
  o.standing_tolerance = 3 * mm;
  return o;
}

bool error_at(const geodesy::Trajectory& t, const geodesy::TrajectoryPoint& truth, Eigen::Vector3d& e,
              Eigen::Matrix3d& P) {
  const std::size_t i = t.lower_bound(truth.time);
  if (i == 0 || i >= t.size()) return false;
  const auto &a = t[i - 1], &b = t[i];
  const double u = (truth.time - a.time).seconds() / (b.time - a.time).seconds();
  e = (1 - u) * geodesy::wgs84.ned_difference(truth.position, a.position) +
      u * geodesy::wgs84.ned_difference(truth.position, b.position);
  P = a.position_covariance.matrix();
  return true;
}

}  // namespace versine::study

// SPDX-License-Identifier: Apache-2.0
#include "versine/app/survey_config.hpp"

#include <array>
#include <cmath>

#include "versine/app/survey_landmark.hpp"
#include "versine/core/units.hpp"
#include "versine/geodesy/attitude.hpp"

namespace versine::app {

namespace {
template <class Enum, std::size_t N>
using Words = std::array<std::pair<std::string_view, Enum>, N>;

constexpr Words<SurveyMethod, 2> methods{
    {{"aided-ins", SurveyMethod::aided_ins}, {"landmark", SurveyMethod::landmark}}};
constexpr Words<fusion::HeadingSource, 4> heading_sources{{{"auto", fusion::HeadingSource::automatic},
                                                           {"gyrocompass", fusion::HeadingSource::gyrocompass},
                                                           {"course", fusion::HeadingSource::course},
                                                           {"given", fusion::HeadingSource::given}}};
constexpr Words<fusion::SmootherKind, 3> smoothers{{{"bryson-frazier", fusion::SmootherKind::bryson_frazier},
                                                    {"rts", fusion::SmootherKind::rauch_tung_striebel},
                                                    {"none", fusion::SmootherKind::none}}};
constexpr Words<fusion::RobustWeight, 2> weights{
    {{"none", fusion::RobustWeight::none}, {"huber", fusion::RobustWeight::huber}}};
constexpr Words<fusion::OdometerUse, 2> odometer_uses{
    {{"distance", fusion::OdometerUse::distance}, {"speed", fusion::OdometerUse::speed}}};

constexpr KeySpec metres(std::string_view doc, double min = 0.0) {
  return {.doc = doc, .unit = "m", .min = min};
}
constexpr KeySpec seconds(std::string_view doc) {
  return {.doc = doc, .unit = "s", .min = 0};
}
constexpr KeySpec speed(std::string_view doc) {
  return {.doc = doc, .unit = "m/s", .max = 100, .positive = true};
}

void describe_lever(ConfigVisitor& v, std::string_view key, std::string_view sigma_key, fusion::LeverArm& lever,
                    std::string_view doc) {
  v.value(key, lever.l_b, {.doc = doc, .unit = "m", .min = -50, .max = 50});
  if (!sigma_key.empty()) {
    v.value(
        sigma_key, lever.sigma,
        {.doc = "What is unknown of it, each component; above 0 it is estimated.", .unit = "m", .min = 0, .max = 10});
  }
}

void describe_imu(ConfigVisitor& v, SurveyConfig& c) {
  describe(v, c.imu);
  describe(v, c.imu_errors);
  auto& e = c.estimator;
  static constexpr Words<fusion::BiasInstability, 2> instabilities{
      {{"gauss-markov", fusion::BiasInstability::gauss_markov}, {"flicker", fusion::BiasInstability::flicker}}};
  v.choice<fusion::BiasInstability>("instability", e.instability, instabilities,
                                    {.doc = "How the biases vary: with their correlation time, or as 1/f noise (an "
                                            "Allan deviation with a flat floor)."});
  Eigen::Vector3d mounting(e.mounting.roll, e.mounting.pitch, e.mounting.yaw);
  v.value("mounting_deg", mounting,
          {.doc = "Attitude of the IMU in the vehicle: roll, pitch, yaw that turn the vehicle's axes into the IMU's.",
           .unit = "deg",
           .scale = units::deg,
           .min = -360,
           .max = 360});
  e.mounting = {mounting.x(), mounting.y(), mounting.z()};
  v.value("mounting_sigma_deg", e.mounting_sigma,
          {.doc = "What is unknown of it; above 0 pitch and yaw are estimated.",
           .unit = "deg",
           .scale = units::deg,
           .min = 0,
           .max = 45});
  v.value("max_tilt_deg", c.max_tilt,
          {.doc = "Largest angle between gravity and the IMU's down axis that is believed; more is an error in axes.",
           .unit = "deg",
           .scale = units::deg,
           .max = 180,
           .positive = true});
}

void describe_gnss(ConfigVisitor& v, SurveyConfig& c) {
  describe(v, c.gnss);
  describe(v, c.gnss_raw);
  auto& e = c.estimator;
  describe_lever(v, "lever_arm_m", "lever_arm_sigma_m", e.gnss_lever,
                 "From the IMU to the antenna: forward, right, "
                 "down, in the IMU's axes.");
  v.value("fixed_only", c.fixed_only, {.doc = "Use epochs with fixed ambiguities only."});
  v.value("position", e.use_gnss_position, {.doc = "Use the positions."});
  v.value("velocity", e.use_gnss_velocity, {.doc = "Use the receiver's velocities where it gives them."});
  v.value("sigma_factor", e.gnss_sigma_scale,
          {.doc = "The receiver's standard deviations are multiplied by this.", .max = 1000, .positive = true});
  v.value("sigma_minimum_m", e.gnss_sigma_minimum, metres("None is taken smaller than this."));
  v.value("bias_sigma_m", e.gnss_bias, metres("Slowly varying error of the positions, estimated when above 0."));
  v.value("bias_sigma_up_m", e.gnss_bias_up, metres("The same of heights; 0: as bias_sigma_m."));
  v.value("bias_time_s", e.gnss_bias_time, seconds("Its correlation time."));
}

void describe_wheels(ConfigVisitor& v, SurveyConfig& c) {
  auto& e = c.estimator;
  v.tables<OdometerFileConfig>("odometer", "An odometer; a second [[odometer]] is a second wheel.", c.odometers,
                               [](ConfigVisitor& t, OdometerFileConfig& f) { describe(t, f); });
  v.table("speed", "A speedometer.", [&](ConfigVisitor& t) {
    describe(t, c.speed);
    t.value("sigma_mps", e.speed_sigma, speed("Of one reading."));
    t.value("correlation_time_s", e.speed_correlation_time,
            seconds("Errors of neighbouring readings are alike for "
                    "this long."));
  });
  v.table("wheel", "What odometer and speedometer are worth, and where the wheel is.", [&](ConfigVisitor& t) {
    describe_lever(t, "lever_arm_m", "lever_arm_sigma_m", e.wheel_lever,
                   "From the IMU to the point that odometer and constraint hold for, the middle of the wheelbase.");
    t.choice<fusion::OdometerUse>("use", e.odometer_use, odometer_uses,
                                  {.doc = "Increments of distance between readings, or speed formed from them."});
    t.value("sigma_m", e.odometer_sigma, metres("Of one reading: pulse length / sqrt(12)."));
    t.value("random_walk_mpsqrtm", e.odometer_random_walk,
            {.doc = "Slip and uneven rolling, per root of the distance.", .unit = "m/sqrt(m)", .min = 0});
    t.value("scale_sigma", e.odometer_scale_sigma,
            {.doc = "What is unknown of the scale factor.", .max = 0.5, .positive = true});
    t.value("scale_walk_psqrts", e.odometer_scale_walk,
            {.doc = "Drift of the scale factor.", .unit = "1/sqrt(s)", .min = 0});
  });
  v.table("constraint", "Non-holonomic constraint: wheels on rails go neither sideways nor up.", [&](ConfigVisitor& t) {
    t.value("on", e.constraint, {.doc = "Use it."});
    t.value("sigma_mps", e.constraint_sigma, speed("Of the velocity across and up, at least."));
    t.value("angle_rad", e.constraint_angle,
            {.doc = "Motion across per motion forward (irregularity, side slip).", .unit = "rad", .min = 0, .max = 1});
    t.value("correlation_m", e.constraint_correlation, metres("Over this distance that angle stays alike."));
    t.value("wander_mm", e.constraint_wander,
            {.doc = "Wheels that guide a beam along a rail stray from where it points, and come back: mean over one "
                    "metre. Positive: the constraint holds for the sum of their way, and sigma and angle are what adds "
                    "up over a run. 0: it holds for the velocity only, for wheels that may slip.",
             .unit = "mm sqrt(m)",
             .scale = units::mm,
             .min = 0});
    t.value("interval_s", e.constraint_interval, seconds("Between two applications; 0: every covariance step."));
    t.value("peak_rad", e.constraint_peak,
            {.doc = "Single angles may be so much larger before they count as faults: short irregularities, which a "
                    "wheelbase on cancel.",
             .unit = "rad",
             .min = 0,
             .max = 1});
  });
  v.table("standstill", "Zero velocity and zero turn rate while the vehicle stands.", [&](ConfigVisitor& t) {
    t.value("on", e.zero_velocity, {.doc = "Detect standstill and use it."});
    t.value("after_alignment", e.zero_velocity_after_alignment,
            {.doc = "Use it after the initial alignment, too; false: a standing vehicle shows how its IMU drifts."});
    t.value("minimum_s", e.standstill.minimum, seconds("Shorter ones are not used."));
    t.value("margin_s", e.standstill.margin, seconds("Taken off both ends, where the vehicle still rocks."));
    t.value(
        "acceleration_spread_mps2", e.standstill.acceleration_spread,
        {.doc =
             "Standard deviation of the specific force in one second that still counts as standing, and change of its "
             "mean since the standstill began.",
         .unit = "m/s^2",
         .positive = true});
    t.value("rate_spread_radps", e.standstill.rate_spread,
            {.doc = "The same of the angular rate.", .unit = "rad/s", .positive = true});
    t.value("rate_mean_radps", e.standstill.rate_mean,
            {.doc = "Mean angular rate beyond the gyros' bias.", .unit = "rad/s", .positive = true});
    t.value("zero_rate_sigma_radps", e.zero_rate_sigma,
            {.doc = "Of the zero angular rate, beyond the gyros' noise.", .unit = "rad/s", .positive = true});
    t.value("sigma_mps", e.zero_velocity_sigma, speed("Of the zero velocity, mean over an interval."));
    t.value("interval_s", e.zero_interval, seconds("Between two updates while standing."));
    t.value(
        "position_sigma_m", e.zero_position_sigma,
        metres("How far rocking moves the vehicle about its mean place; while it stands its position is that. Over an "
               "interval it makes a mean velocity, which adds to sigma_mps."));
  });
}

void describe_alignment(ConfigVisitor& v, SurveyConfig& c) {
  auto& e = c.estimator;
  v.choice<fusion::HeadingSource>("heading", e.heading_source, heading_sources,
                                  {.doc = "Gyrocompass while standing, course of the GNSS in motion, or given; auto "
                                          "takes the first that instrument and recording allow."});
  v.value("heading_deg", e.initial_heading,
          {.doc = "Given heading of the vehicle's forward axis, from north "
                  "clockwise.",
           .unit = "deg",
           .scale = units::deg,
           .min = -360,
           .max = 360});
  v.value("heading_sigma_deg", e.initial_heading_sigma,
          {.doc = "Of the given heading.", .unit = "deg", .scale = units::deg, .max = 180, .positive = true});
  v.value("duration_s", e.alignment_duration,
          {.doc = "Of the first standstill, used for coarse alignment.", .unit = "s", .max = 7200, .positive = true});
  v.value("position", c.initial_position,
          {.doc = "Latitude, longitude (deg) and height (m) at the start, for runs "
                  "without GNSS and landmarks.",
           .example = "[34.246048, 108.909664, 380.0]"});
  if (c.initial_position.size() == 3) {
    e.initial_position = {c.initial_position[0] * units::deg, c.initial_position[1] * units::deg,
                          c.initial_position[2]};
  }
  v.value("position_sigma_m", e.initial_position_sigma, {.doc = "Of that position.", .unit = "m", .positive = true});
  v.value("course_minimum_speed_mps", e.course.minimum_speed, speed("Slower courses are not taken."));
}

void describe_filter(ConfigVisitor& v, fusion::AidedInsOptions& e) {
  v.choice<fusion::SmootherKind>("smoother", e.smoother, smoothers,
                                 {.doc = "Backward pass: modified Bryson-Frazier, Rauch-Tung-Striebel, or none."});
  v.value("covariance_rate_hz", e.covariance_rate,
          {.doc = "How often the covariance is propagated; transition matrices in between are accumulated exactly.",
           .unit = "Hz",
           .max = 1000,
           .positive = true});
  v.value("gate_probability", e.gate_probability,
          {.doc = "Chance that a good measurement is rejected.", .max = 0.5, .positive = true});
  v.choice<fusion::RobustWeight>("robust", e.robust, weights, {.doc = "Down-weighting of large innovations."});
  v.value("most_rejections", e.most_rejections,
          {.doc = "After so many in a row the filter, not the sensor, is "
                  "doubted.",
           .min = 1});
  v.value(
      "doubt_after_s", e.doubt_after,
      seconds(
          "With positions, only when the rejections have lasted this long: wrong ambiguities last for seconds. 0: as "
          "long as the accelerometers' bias alone keeps the position within 0.3 m."));
  v.value("gravity_walk_mgalpsqrtkm", e.gravity_walk,
          {.doc = "Change of gravity against its normal value, in size and direction, per root of the distance.",
           .unit = "mGal/sqrt(km)",
           .scale = units::mGal / std::sqrt(1000.0),
           .min = 0,
           .max = 1000});
  v.value("monitor_length", e.monitor_length,
          {.doc = "Innovations whose mean is watched for slow faults; 0: off.", .min = 0});
}

/// The instrument's axes: the zero of its circle, to its right, down its standing axis.
void describe_instrument_mounting(ConfigVisitor& v, SurveyConfig& c) {
  auto& t = c.total_station;
  v.value(
      "mounting_deg", t.mounting,
      {.doc = "Attitude of the instrument on the trolley against the IMU: roll, pitch, yaw that turn the IMU's axes "
              "into the instrument's (circle's zero, right, down); given, its roll and heading go to the filter too.",
       .unit = "deg"});
  if (t.mounting) {
    const Eigen::Vector3d m = *t.mounting * units::deg;
    c.estimator.q_bs = geodesy::to_quaternion(geodesy::Euler{m.x(), m.y(), m.z()});
  }
  v.value("mounting_sigma_arcsec", t.mounting_sigma,
          {.doc = "What is unknown of it.", .unit = "arcsec", .scale = units::arcsec, .min = 0});
  v.value("check_control", t.check_control,
          {.doc = "Adjust all stations and control points together with the trajectory (control_points.csv), and name "
                  "points that have moved since their survey."});
}

void describe_output(ConfigVisitor& v, SurveyConfig& c) {
  auto& e = c.estimator;
  v.value("folder", c.output.folder, {.doc = "Result folder; default: the job's name with .result, beside the job."});
  v.value("crs", c.output.crs,
          {.doc = "CRS of easting and northing; default: the UTM zone of the start.", .example = "\"EPSG:25832\""});
  v.value("rate_hz", c.output.rate,
          {.doc = "Rate of the trajectory; 0: at every IMU sample; default: 10, for [geometry] 50, since waves of a "
                  "metre need a point every few centimetres.",
           .unit = "Hz",
           .min = 0});
  v.value("csv", c.output.csv, {.doc = "Write trajectory.csv."});
  v.value("hdf5", c.output.hdf5, {.doc = "Write trajectory.h5."});
  v.value("forward", e.keep_forward, {.doc = "Keep the forward filter's trajectory, too."});
  v.value("dead_reckoning", e.dead_reckoning, {.doc = "Also dead reckoning with smoothed attitude and odometer."});
  v.value("innovations", c.output.innovations, {.doc = "Write innovations.csv."});
  v.value("innovation_interval_s", e.innovation_interval,
          seconds("Between kept innovations of odometer, constraint and standstill; 0: all."));
  v.value("sensor_error_interval_s", e.sensor_error_interval,
          {.doc = "Between samples of biases and scale factors.", .unit = "s", .positive = true});
  v.value("chain_rate_hz", e.chain_rate,
          {.doc = "Rate at which joint covariances are kept for the sigmas of versines; "
                  "0: none.",
           .unit = "Hz",
           .min = 0,
           .max = 100});
}
}  // namespace

void describe(ConfigVisitor& v, SurveyConfig& c) {
  v.value("job", c.job, {.doc = "Kind of this job.", .required = true, .example = "\"survey\""});
  v.value("title", c.title, {.doc = "Line and track, for reports.", .example = "\"Line 6240, track 1\""});
  v.choice<SurveyMethod>("method", c.method, methods,
                         {.doc = "Aided INS, or dead reckoning with gyros, odometer and landmarks."});
  v.table("imu", "The inertial measurement unit.", [&](ConfigVisitor& t) { describe_imu(t, c); });
  v.table("gnss", "Positions from satellites.", [&](ConfigVisitor& t) { describe_gnss(t, c); });
  describe_wheels(v, c);
  v.table("heading", "Headings of the vehicle from a dual antenna or from the track's azimuth.",
          [&](ConfigVisitor& t) { describe(t, c.heading); });
  v.table("landmarks", "Positions known from outside while the vehicle stands: total station, prism, marked points.",
          [&](ConfigVisitor& t) {
            describe(t, c.landmarks);
            describe_lever(t, "lever_arm_m", "", c.estimator.landmark_lever,
                           "From the IMU to the instrument or prism.");
          });
  v.table("total_station", "Raw readings of a total station, instead of positions: docs/total-station.md.",
          [&](ConfigVisitor& t) {
            describe(t, c.total_station);
            describe_lever(t, "lever_arm_m", "", c.estimator.landmark_lever,
                           "From the IMU to the instrument or prism.");
            describe_instrument_mounting(t, c);
          });
  v.table("alignment", "Initial attitude and position.", [&](ConfigVisitor& t) { describe_alignment(t, c); });
  v.table("filter", "The estimator.", [&](ConfigVisitor& t) { describe_filter(t, c.estimator); });
  v.table("landmark_method", "What method = \"landmark\" wants to know besides (docs/planning.md).",
          [&](ConfigVisitor& t) { describe(t, c.landmark_method); });
  v.table("withhold", "Leaves GNSS out in windows and compares with it: how good is the solution in outages?",
          [&](ConfigVisitor& t) {
            t.value("window_s", c.withhold.window, seconds("Length of a window; 0: nothing is withheld."));
            t.value("every_s", c.withhold.every,
                    seconds("From the start of one window to the next; 0: three times the "
                            "length."));
            t.value("start_s", c.withhold.start, seconds("First window after the first epoch."));
          });
  v.table(
      "geometry", "Track geometry from the trajectory (docs/track-geometry.md); without this table there is none.",
      [&](ConfigVisitor& t) { describe(t, c.geometry); }, &c.geometry.present);
  v.table(
      "report", "A report beside the result (docs/report.md); without this table none is made.",
      [&](ConfigVisitor& t) { describe(t, c.report, true); }, &c.report.present);
  v.table("output", "What is written, and where.", [&](ConfigVisitor& t) { describe_output(t, c); });
}

Expected<SurveyConfig> read_survey_config(const std::filesystem::path& job, std::span<const std::string> overrides) {
  SurveyConfig config;
  if (auto done = read_config(
          job, [&](ConfigVisitor& v) { describe(v, config); }, overrides);
      !done) {
    return tl::unexpected(done.error());
  }
  auto errors = config.imu_errors.errors();
  if (!errors) {
    Error error = std::move(errors.error());
    error.file = job.string();
    error.field = "imu." + error.field;
    return tl::unexpected(std::move(error));
  }
  config.estimator.imu_errors = *errors;
  config.output.rate = config.output.rate.value_or(config.geometry.present ? 50.0 : 10.0);
  config.estimator.output_rate = *config.output.rate;
  if (config.geometry.present) {
    config.geometry.trolley.mounting = config.estimator.mounting;
    if (config.geometry.crs.empty()) config.geometry.crs = config.output.crs;
    // Sigmas of versines need the joint errors.
    if (config.estimator.chain_rate == 0.0) config.estimator.chain_rate = 1.0;
  }
  return config;
}

}  // namespace versine::app

// SPDX-License-Identifier: Apache-2.0
#include "versine/app/constraints.hpp"
#include "versine/app/georef.hpp"
#include "versine/core/units.hpp"

namespace versine::app {

namespace {
void describe_monitoring(ConfigVisitor& t, MonitoringConfig& m) {
  t.value("file", m.file,
          {.doc = "HDF5 or CSV; read block by block, never changed.", .required = true, .example = "\"axlebox.h5\""});
  t.value("channels", m.channels, {.doc = "Datasets or columns.", .required = true, .example = "[\"axlebox/left\"]"});
  t.value("times", m.times, {.doc = "Dataset (s, or integer ns) or column (s) of times; or rate_hz and start_s."});
  t.value("rate_hz", m.rate_hz, {.doc = "Sampling rate.", .unit = "1/s", .positive = true});
  t.value("start_s", m.start, {.doc = "Time of the first sample, with rate_hz.", .unit = "s"});
  t.value("offset_s", m.offset, {.doc = "Added to every time: the recording's clock minus this file's.", .unit = "s"});
  t.value("scale", m.scale, {.doc = "The channels' numbers times this."});
  t.value("recording", m.recording, {.doc = "Of which recording of the job, counted from 1.", .min = 1});
  t.value("bin_m", m.options.bin, {.doc = "Length over which RMS and peak are taken.", .unit = "m", .positive = true});
  t.value("slowest_mps", m.options.slowest,
          {.doc = "Slower samples are left out of RMS and peak.", .unit = "m/s", .min = 0.0});
  t.value("position_rate_hz", m.options.position_rate,
          {.doc = "Exact positions as often; 0: none.", .unit = "1/s", .min = 0.0});
}

void describe(ConfigVisitor& v, RecordingConfig& r) {
  v.value("name", r.name, {.doc = "In results; none: the GNSS file as written."});
  v.table("gnss", "Positions, and speed where the file has it.", [&](ConfigVisitor& t) { describe(t, r.gnss); });
  v.table("imu", "Accelerations and turn rates; the forward axis is found from the movement.",
          [&](ConfigVisitor& t) { describe(t, r.imu); });
  v.table("speed", "Speed over the rails.", [&](ConfigVisitor& t) { describe(t, r.speed); });
  v.table("odometer", "Distance or pulses.", [&](ConfigVisitor& t) { describe(t, r.odometer); });
}

}  // namespace

Expected<void> load_constraints(GeorefConfig& c) {
  if (c.constraints_file.empty()) return {};
  const auto constraints = read_constraints(c.constraints_file.path);
  if (!constraints) return tl::unexpected(constraints.error());
  c.constraints.insert(c.constraints.end(), constraints->begin(), constraints->end());
  return {};
}

Expected<GeorefCompanion> read_companion(const std::filesystem::path& path) {
  GeorefCompanion out;
  const auto read = read_config(path, [&](ConfigVisitor& v) {
    describe(v, out.constraints);
    v.tables<MonitoringConfig>("monitoring", "Monitoring channels to be put on the track.", out.monitoring,
                               describe_monitoring);
  });
  if (!read) return tl::unexpected(read.error());
  return out;
}

void describe(ConfigVisitor& v, GeorefConfig& c) {
  v.value("job", c.job, {.doc = "Kind of job.", .example = "\"georef\""});
  v.value("title", c.title, {.doc = "For people."});
  v.table("network", "The railway map.", [&](ConfigVisitor& t) {
    t.value("file", c.network,
            {.doc = "GeoPackage, GeoJSON, Shapefile, OpenStreetMap PBF or XML.",
             .required = true,
             .example = "\"network.gpkg\""});
    t.value("layer", c.layer, {.doc = "Layer of the tracks; none: the first with lines."});
    t.value("id_field", c.id_field, {.doc = "Attribute that names a track; none: id, track_id or name."});
    t.value("source_crs", c.source_crs, {.doc = "CRS of the file, when it does not tell it or tells it wrongly."});
    t.value("crs", c.crs,
            {.doc = "Projection to work in: a PROJ definition or 'utm'; none: the file's own, or a transverse Mercator "
                    "on its middle meridian."});
    t.value("osm_types", c.osm_types, {.doc = "Values of OpenStreetMap's railway tag to be read."});
    t.value("snap_m", c.snap,
            {.doc = "Track ends nearer than this are connected.", .unit = "m", .max = 10.0, .positive = true});
    t.value("largest_turn_deg", c.largest_turn,
            {.doc = "A wheel passes an unlabelled joint that turns by less than this.",
             .unit = "deg",
             .scale = units::deg,
             .max = 90.0,
             .positive = true});
  });
  v.value(
      "recordings", c.recordings,
      {.doc = "Files that hold whole recordings: HDF5 in the OnboardEU layout, or GNSS as CSV, NMEA or RTKLIB .pos.",
       .example = "[\"journey.h5\"]"});
  v.value("constraints", c.constraints_file,
          {.doc = "File of [[constraint]] tables, as a review of paths writes it.", .example = "\"constraints.toml\""});
  v.tables<RecordingConfig>("recording", "A recording in several files, or whose columns need names.", c.tables,
                            [](ConfigVisitor& t, RecordingConfig& r) { describe(t, r); });
  auto& o = c.options;
  v.table("gnss", "Errors of GNSS.", [&](ConfigVisitor& t) {
    t.value("sigma_scale", o.gnss.scale,
            {.doc = "The receiver's own sigmas times this.", .max = 20.0, .positive = true});
    t.value("correlated_share", o.gnss.correlated,
            {.doc = "Share of a fix's variance that is correlated in time.", .min = 0.0, .max = 0.99});
    t.value("correlation_time_s", o.gnss.correlation_time,
            {.doc = "Correlation time of that part.", .unit = "s", .positive = true});
    t.value(
        "jump", o.gnss.jump,
        {.doc = "Normalised innovation squared beyond which the correlated error is taken to begin afresh, as under "
                "a bridge.",
         .positive = true});
    t.value("gate", o.gnss.gate,
            {.doc = "Normalised innovation squared beyond which a fix is left out.", .positive = true});
    t.value("map_sigma_m", o.gnss.map_sigma, {.doc = "Lateral error of the map.", .unit = "m", .positive = true});
  });
  v.table("motion", "What no sensor tells of the acceleration.", [&](ConfigVisitor& t) {
    t.value("sigma_with_imu_mps2", o.with_imu.sigma,
            {.doc = "Bias and slope, with an IMU.", .unit = "m/s^2", .positive = true});
    t.value("time_with_imu_s", o.with_imu.time, {.doc = "Their correlation time.", .unit = "s", .positive = true});
    t.value("sigma_without_imu_mps2", o.without_imu.sigma,
            {.doc = "Acceleration, without an IMU.", .unit = "m/s^2", .positive = true});
    t.value("time_without_imu_s", o.without_imu.time, {.doc = "Its correlation time.", .unit = "s", .positive = true});
    t.value("turn_rate_sigma_deg", o.turn_rate_sigma,
            {.doc = "Of a change of azimuth over a second, gyro and map together.",
             .unit = "deg",
             .scale = units::deg,
             .positive = true});
    t.value("forward_axis", o.forward_axis,
            {.doc = "The vehicle's forward direction in the IMU's axes; none: found from the movement."});
  });
  v.table("journeys", "Splitting a recording.", [&](ConfigVisitor& t) {
    t.value("shortest_s", o.journeys.shortest, {.doc = "Shorter movements are left out.", .unit = "s", .min = 0.0});
    t.value("slowest_mps", o.journeys.slowest,
            {.doc = "The largest speed must exceed this.", .unit = "m/s", .min = 0.0});
    t.value("longest_gap_s", o.journeys.longest_gap,
            {.doc = "A longer time without fixes ends the journey.", .unit = "s", .positive = true});
    t.value("every_stop", o.journeys.every_stop, {.doc = "End a journey at every standstill instead of at reversals."});
  });
  v.table("paths", "Path inference.", [&](ConfigVisitor& t) {
    t.value("hypotheses", o.inference.paths, {.doc = "Paths kept by the coarse search.", .min = 1, .max = 1000});
    t.value("radius_m", o.inference.radius,
            {.doc = "Tracks this near a fix are candidates.", .unit = "m", .positive = true});
    t.value("diverging_probability", o.inference.diverging,
            {.doc = "Prior probability of the diverging leg of a switch.", .min = 0.001, .max = 0.999});
    t.value("top_speed_mps", o.inference.top_speed,
            {.doc = "No vehicle of the recordings is faster.", .unit = "m/s", .positive = true});
    t.value(
        "largest_sigma_m", o.inference.largest_sigma,
        {.doc = "A fix with a larger sigma serves to find the path, not the distance.", .unit = "m", .positive = true});
    t.value("smallest_probability", o.smallest_probability,
            {.doc = "Less probable paths are not reported.", .min = 0.0, .max = 0.5});
    static constexpr std::pair<std::string_view, georef::Linearisation> words[] = {
        {"central-difference", georef::Linearisation::central_difference},
        {"unscented", georef::Linearisation::unscented}};
    t.choice("linearisation", o.linearisation,
             std::span<const std::pair<std::string_view, georef::Linearisation>>(words),
             {.doc = "Of the path in the position update."});
    t.value("jacobian_step_m", o.jacobian_step,
            {.doc = "Step of the central difference.", .unit = "m", .positive = true});
  });
  describe(v, c.constraints);
  v.tables<MonitoringConfig>("monitoring", "Monitoring channels to be put on the track.", c.monitoring,
                             describe_monitoring);
  v.table("online", "Replay through the online filter (versine georef --online).", [&](ConfigVisitor& t) {
    t.value("decide", c.online.decide,
            {.doc = "Probability from which a leg of a switch is decided.", .min = 0.5, .max = 0.999999});
    int most = static_cast<int>(c.online.hypotheses);
    t.value("hypotheses", most, {.doc = "Kept at most.", .min = 2, .max = 1000});
    c.online.hypotheses = static_cast<std::size_t>(most);
  });
  v.table(
      "report", "A report beside the result (docs/report.md); without this table none is made.",
      [&](ConfigVisitor& t) { describe(t, c.report, false); }, &c.report.present);
  v.table("output", "Results.", [&](ConfigVisitor& t) {
    t.value("csv_interval_s", c.csv_interval,
            {.doc = "Between rows of positions.csv and points of the GeoPackage; the HDF5 file has every grid step.",
             .unit = "s",
             .positive = true});
    t.value("hdf5", c.hdf5, {.doc = "Write georef.h5: every grid step of every plausible path."});
    t.value("gpkg", c.gpkg, {.doc = "Write result.gpkg for a geographic information system."});
  });
}

}  // namespace versine::app

// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "versine/app/stationing.hpp"

namespace versine::app {
namespace {

using Arrangement = StationingProcessing::Arrangement;
constexpr std::array<std::pair<std::string_view, Arrangement>, 2> arrangements{
    {{"on_trolley", Arrangement::on_trolley}, {"beside", Arrangement::beside}}};
constexpr std::array<std::pair<std::string_view, TimeScale>, 3> scales{
    {{"gps", TimeScale::gps}, {"utc", TimeScale::utc}, {"recorder", TimeScale::recorder}}};

void describe_instrument(ConfigVisitor& v, stationing::Instrument& i) {
  v.value("angle_sigma_arcsec", i.angle_sigma,
          {.doc = "Of a direction or zenith angle in both faces once (ISO 17123-3).",
           .unit = "arcsec",
           .scale = units::arcsec,
           .positive = true});
  v.value("distance_sigma_mm", i.distance_sigma,
          {.doc = "Constant part of a distance's standard deviation (ISO 17123-4).",
           .unit = "mm",
           .scale = units::mm,
           .positive = true});
  v.value("distance_sigma_ppm", i.distance_sigma_ppm,
          {.doc = "Part that grows with the distance.", .unit = "ppm", .min = 0});
  v.value("target_sigma_mm", i.target_sigma,
          {.doc = "Of a prism about its point, each direction.", .unit = "mm", .scale = units::mm, .min = 0});
  v.value("collimation_arcsec", i.collimation,
          {.doc = "From a calibration, for targets read in one face.", .unit = "arcsec", .scale = units::arcsec});
  v.value("index_error_arcsec", i.index_error,
          {.doc = "Of the vertical circle, as before.", .unit = "arcsec", .scale = units::arcsec});
  v.value("one_face", i.one_face,
          {.doc = "Readings in face I alone are meant so: the instrument corrects its axis errors itself."});
  v.value("scale_ppm", i.scale_ppm, {.doc = "Known correction of the distances' scale.", .unit = "ppm"});
  v.value("wavelength_um", i.wavelength, {.doc = "Of the distance meter.", .unit = "um", .min = 0.4, .max = 1.1});
  v.value("refraction", i.refraction, {.doc = "Coefficient k; 0 in still tunnel air.", .min = -4, .max = 4});
}

void describe_computation(ConfigVisitor& v, stationing::FreeStationOptions& o) {
  std::optional<double> tilt = o.tilt_sigma ? std::optional(*o.tilt_sigma / units::arcsec) : std::nullopt;
  v.value("tilt_sigma_arcsec", tilt,
          {.doc = "The instrument is levelled this well; leave out when it lies as the trolley lies.",
           .unit = "arcsec",
           .positive = true});
  if (tilt) o.tilt_sigma = *tilt * units::arcsec;
  v.value("solve_scale", o.solve_scale, {.doc = "Estimate the scale of the distances at each station."});
  v.value("identify", o.identify, {.doc = "Find targets without or with unknown numbers by their coordinates."});
  v.value("tolerance_mm", o.tolerance,
          {.doc = "To recognise a point by its coordinates.", .unit = "mm", .scale = units::mm, .positive = true});
  v.value("significance", o.significance,
          {.doc = "Share of good targets that the blunder test may lose.", .min = 1e-9, .max = 0.1});
  v.value("wanted_sigma_mm", o.wanted_sigma,
          {.doc = "A station's position sigma above this is reported as poor geometry.",
           .unit = "mm",
           .scale = units::mm,
           .positive = true});
}

}  // namespace

void describe(ConfigVisitor& v, StationingProcessing& s) {
  v.value("readings", s.readings,
          {.doc = "Raw readings: CSV, Leica GSI, Sokkia SDR or GeoEasy (docs/formats/total-station.md).",
           .example = "[\"readings.csv\"]"});
  v.value("control", s.control,
          {.doc = "Control points: CSV, LandXML CgPoints or Leica GSI.", .example = "[\"control.csv\"]"});
  v.value("columns", s.columns, {.doc = "Foreign headers of the readings."});
  v.value("crs", s.crs,
          {.doc = "Map projection of the control points, when they are easting and northing.",
           .example = "\"EPSG:25832\""});
  v.value(
      "origin", s.origin,
      {.doc = "Latitude and longitude (deg) and height (m) of the origin, when control points are north, east, up."});
  v.value("control_sigma_mm", s.control_sigma,
          {.doc = "Of each coordinate, where the list gives none.", .unit = "mm", .scale = units::mm, .min = 0});
  v.choice<TimeScale>("time_scale", s.time_scale, scales,
                      {.doc = "Of the times of the readings; that of the recording."});
  v.choice<Arrangement>(
      "arrangement", s.arrangement, arrangements,
      {.doc = "Where the instrument stands: on the trolley, or beside the track watching its prism."});
  v.value("prism", s.prism,
          {.doc = "Number of the trolley's prism in the readings, when the instrument stands beside."});
  describe_instrument(v, s.instrument);
  describe_computation(v, s.options);
}

}  // namespace versine::app

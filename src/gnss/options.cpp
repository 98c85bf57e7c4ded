// SPDX-License-Identifier: Apache-2.0
#include "versine/gnss/options.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "versine/core/units.hpp"

namespace versine::gnss {
namespace {

const char* mode(Positioning p) {
  switch (p) {
    case Positioning::single:
      return "single";
    case Positioning::differential:
      return "dgps";
    case Positioning::standing:
      return "static";
    case Positioning::kinematic:
      return "kinematic";
  }
  return "kinematic";
}

const char* resolution(Ambiguities a) {
  switch (a) {
    case Ambiguities::floating:
      return "off";
    case Ambiguities::continuous:
      return "continuous";
    case Ambiguities::instantaneous:
      return "instantaneous";
    case Ambiguities::hold:
      return "fix-and-hold";
  }
  return "continuous";
}

const char* order(Direction d) {
  switch (d) {
    case Direction::forward:
      return "forward";
    case Direction::backward:
      return "backward";
    case Direction::combined:
      return "combined";
  }
  return "combined";
}

int system_mask(const std::vector<std::string>& systems) {
  constexpr std::array<std::pair<std::string_view, int>, 6> bits{
      {{"GPS", 1}, {"SBAS", 2}, {"GLONASS", 4}, {"Galileo", 8}, {"QZSS", 16}, {"BeiDou", 32}}};
  int mask = 0;
  for (const auto& s : systems) {
    for (const auto& [name, bit] : bits) mask |= s == name ? bit : 0;
  }
  return mask;
}

}  // namespace

std::string rtklib_configuration(const Options& o, Direction direction) {
  std::string text;
  const auto set = [&](std::string_view key, const auto& value) { text += fmt::format("{:<19}={}\n", key, value); };
  set("pos1-posmode", mode(o.positioning));
  set("pos1-frequency", o.frequencies == 1 ? "l1" : o.frequencies == 2 ? "l1+l2" : "l1+l2+l5");
  set("pos1-soltype", order(direction));
  set("pos1-elmask", o.elevation_mask / units::deg);
  if (o.snr_mask > 0.0) {
    const std::string levels =
        fmt::format("{0:.0f},{0:.0f},{0:.0f},{0:.0f},{0:.0f},{0:.0f},{0:.0f},{0:.0f},{0:.0f}", o.snr_mask);
    set("pos1-snrmask_r", "on");
    set("pos1-snrmask_b", "on");
    for (const char* band : {"pos1-snrmask_L1", "pos1-snrmask_L2", "pos1-snrmask_L5"}) set(band, levels);
  }
  set("pos1-dynamics", o.dynamics ? "on" : "off");
  set("pos1-ionoopt", "brdc");
  set("pos1-tropopt", "saas");
  set("pos1-sateph", "brdc");
  set("pos1-navsys", system_mask(o.systems));
  set("pos2-armode", resolution(o.ambiguities));
  set("pos2-gloarmode", o.glonass_ambiguities ? "on" : "off");
  set("pos2-arthres", o.ratio);
  set("pos2-arlockcnt", o.lock_epochs);
  set("pos2-arelmask", o.fix_elevation / units::deg);
  set("pos2-maxage", o.max_age);
  set("out-solformat", "llh");
  set("out-outhead", "on");
  set("out-timesys", "gpst");
  set("out-timeform", "tow");
  set("out-timendec", 3);
  set("out-degform", "deg");
  set("out-height", "ellipsoidal");
  set("out-solstatic", "all");
  if (!o.antenna_file.empty()) set("file-rcvantfile", o.antenna_file);
  set("ant1-anttype", o.rover_antenna);
  set("ant1-antdelu", o.rover_antenna_height);
  set("ant2-anttype", o.base_antenna);
  set("ant2-antdelu", o.base_antenna_height);
  if (o.base_ecef) {
    set("ant2-postype", "xyz");
    for (int i = 0; i < 3; ++i) set(fmt::format("ant2-pos{}", i + 1), fmt::format("{:.6f}", (*o.base_ecef)(i)));
  } else {
    set("ant2-postype", o.average_base ? "single" : "rinexhead");
  }
  set("misc-timeinterp", o.interpolate_base ? "on" : "off");
  return text;
}

}  // namespace versine::gnss

// SPDX-License-Identifier: Apache-2.0
#include "versine/simulation/journey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "versine/network/oriented_graph.hpp"
#include "versine/simulation/world.hpp"

namespace versine::simulation {

namespace {
using network::OrientedTrack;
using network::Path;

/// A stretch of the recording between two reversals: a path as the vehicle faces it, and where on it the stops are.
/// Coordinates go on over a reversal: the place where the vehicle reverses has the same one before and after.
struct Stage {
  Path path;            ///< in the direction that the vehicle faces
  double offset = 0.0;  ///< coordinate of the path's beginning
  bool forward = true;
  double start = 0.0;  ///< coordinate
  std::vector<Leg> legs;
};

Path opposite(const Path& path) {
  Path out;
  for (auto t = path.rbegin(); t != path.rend(); ++t) out.push_back(t->opposite());
  return out;
}

double length_of(const network::OrientedGraph& graph, const Path& path, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += graph.length(path[i]);
  return sum;
}

/// Goes on straight beyond the end of a path for at least `room` metres, or to a dead end.
void extend(const network::OrientedGraph& graph, Path& path, double room) {
  for (double gained = 0.0; gained < room;) {
    const auto arcs = graph.successors(path.back());
    if (arcs.empty()) return;
    const auto straight = std::find_if(arcs.begin(), arcs.end(), [](const auto& a) { return !a.diverging; });
    path.push_back(straight == arcs.end() ? arcs.front().to : straight->to);
    gained += graph.length(path.back());
  }
}

/// Extends a stage's path at both ends; coordinates stay.
void extend(const network::OrientedGraph& graph, Stage& stage, double room) {
  extend(graph, stage.path, room);
  Path back = opposite(stage.path);
  const std::size_t before = back.size();
  extend(graph, back, room);
  stage.path = opposite(back);
  stage.offset -= length_of(graph, stage.path, back.size() - before);
}

/// Whether a movement goes the way the vehicle faces: on with a forward stage, or back over a backward one.
bool goes_forward(const std::vector<Stage>& stages, const Movement& way) {
  if (stages.empty()) return true;
  const Stage& last = stages.back();
  return way.path.front() == (last.forward ? last.path.back() : last.path.front());
}

/// Adds a movement to the stage in its direction; a movement against the vehicle's facing is run backwards.
void add_movement(std::vector<Stage>& stages, const network::OrientedGraph& graph, const Movement& way, Leg leg,
                  double here) {
  const bool forward = goes_forward(stages, way);
  leg.to = forward ? here + (way.to - way.from) : here - (way.to - way.from);
  const Path faced = forward ? way.path : opposite(way.path);
  if (stages.empty() || stages.back().forward != forward) {
    const double behind = forward ? way.from : length_of(graph, faced, faced.size()) - way.from;
    stages.push_back({faced, here - behind, forward, here, {leg}});
    return;
  }
  Stage& stage = stages.back();
  stage.legs.push_back(leg);
  if (forward) {
    stage.path.insert(stage.path.end(), faced.begin() + 1, faced.end());
  } else {
    stage.path.insert(stage.path.begin(), faced.begin(), faced.end() - 1);
    stage.offset -= length_of(graph, faced, faced.size() - 1);
  }
}

Expected<std::vector<Stage>> stages_of(const network::Network& network, const network::OrientedGraph& graph,
                                       const JourneyScenario& scenario) {
  std::vector<Stage> stages;
  double here = 0.0;
  for (std::size_t i = 1; i < scenario.stops.size(); ++i) {
    const auto way = find_way(network, scenario.stops[i - 1], scenario.stops[i]);
    if (!way) {
      Error error = way.error();
      error.field = fmt::format("journey[{}].{}", i, error.field);
      return tl::unexpected(std::move(error));
    }
    const JourneyStop& stop = scenario.stops[i];
    add_movement(stages, graph, *way, {.speed = stop.speed, .acceleration = stop.acceleration, .stop = stop.stand},
                 here);
    here = stages.back().legs.back().to;
  }
  return stages;
}

/// Rails of a stage: a curve that rounds the map's corners, and both rails beside it.
Rails rails_of(const network::Network& network, const network::PathCoordinates& path, const Stage& stage,
               const geodesy::LocalFrame& frame, const JourneyScenario& scenario, Stretch reach, double room) {
  const double h = scenario.smoothing, step = 0.5, half_gauge = 0.7175;
  const double begin = std::floor((reach.from - room) / h) * h;
  const auto count = static_cast<Eigen::Index>(std::ceil((reach.to + room - begin) / h)) + 1;
  UniformSpline<3>::Samples control(3, count);
  std::size_t hint = 0;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double d = begin + h * static_cast<double>(k) - stage.offset;
    geodesy::Geodetic g = network.to_geodetic(path.position(d, hint));
    g.height = scenario.height;
    control.col(k) = frame.to_ned(g);
  }
  const auto axis = UniformSpline<3>::smoothing(begin, h, std::move(control));
  Rails rails{frame, {}, step, reach.from, reach.to};
  const double first = begin + 3.0 * h;
  const auto points = static_cast<Eigen::Index>(std::floor((axis.end() - 3.0 * h - first) / step)) + 1;
  UniformSpline<6>::Samples samples(6, points);
  for (Eigen::Index k = 0; k < points; ++k) {
    const auto jet = axis.jet(first + step * static_cast<double>(k));
    const Eigen::Vector3d centre = jet.value;
    const geodesy::Geodetic g = frame.to_geodetic(centre);
    const Eigen::Vector3d down = frame.rotation_from(g).col(2);
    const Eigen::Vector3d right = down.cross(Eigen::Vector3d(jet.first)).normalized();
    samples.col(k) << centre - half_gauge * right, centre + half_gauge * right;
  }
  rails.curve = UniformSpline<6>(first, step, std::move(samples));
  return rails;
}

Stretch reach_of(const Stage& stage) {
  Stretch reach{stage.start, stage.start};
  for (const Leg& leg : stage.legs) {
    reach.from = std::min(reach.from, leg.to);
    reach.to = std::max(reach.to, leg.to);
  }
  return reach;
}
}  // namespace

Expected<std::shared_ptr<const World>> prepare_journey(const network::Network& network,
                                                       const JourneyScenario& scenario) {
  if (scenario.stops.size() < 2) {
    return fail({.field = "journey",
                 .found = fmt::format("{} stops", scenario.stops.size()),
                 .expected = "a place to start and at least one to go to",
                 .advice = "add [[journey]] tables"});
  }
  const network::OrientedGraph graph(network);
  auto stages = stages_of(network, graph, scenario);
  if (!stages) return tl::unexpected(std::move(stages.error()));

  auto world = std::make_shared<World>();
  world->equipment = scenario.equipment;
  world->vehicle = true;
  world->trolley.mounting = scenario.vehicle.mounting;
  world->start = scenario.start;
  world->time_scale = scenario.time_scale;
  world->truth_rate = scenario.truth_rate;
  geodesy::Geodetic origin = network.to_geodetic(Eigen::Vector2d::Zero());
  {
    // Near the journey, not near the map's origin: a tangent frame leans away with the distance.
    const network::PathCoordinates path(network, stages->front().path);
    origin = network.to_geodetic(path.position(0.0));
    origin.height = scenario.height;
  }
  world->frame = geodesy::LocalFrame(origin);

  const double room = 60.0 + scenario.vehicle.bogie_distance + 6.0 * scenario.smoothing;
  double time = 0.0;
  std::size_t stop = 1;
  for (Stage& stage : *stages) {
    extend(graph, stage, 2.0 * room);
    const Stretch reach = reach_of(stage);
    auto path = std::make_shared<const network::PathCoordinates>(network, stage.path);
    auto ids = std::make_shared<std::vector<std::string>>();
    for (const OrientedTrack t : stage.path) ids->push_back(network.tracks[t.track].id);
    const Rails rails = rails_of(network, *path, stage, world->frame, scenario, reach, room);
    Motion motion{.start = stage.start, .stand = time == 0.0 ? scenario.stops.front().stand : 0.0};
    motion.legs = stage.legs;
    auto profile = SpeedProfile::create(motion, reach.from, reach.to, 1);
    if (!profile) {
      profile.error().field = fmt::format("journey[{}]", stop);
      return tl::unexpected(std::move(profile.error()));
    }
    Body body(rails, {}, scenario.vehicle, 1.0, reach);
    if (!world->pieces.empty()) {
      const BodyPose before = world->pieces.back().body.pose(stage.start), after = body.pose(stage.start);
      if ((before.origin - after.origin).norm() > 1e-6) {
        return fail(
            {.field = fmt::format("journey[{}].distance_m", stop - 1),
             .found = fmt::format("a reversal {:.1f} m from the beginning of '{}', with the vehicle on a switch",
                                  scenario.stops[stop - 1].distance, scenario.stops[stop - 1].track),
             .expected = "the whole vehicle behind the switch",
             .advice = fmt::format("stop at least {:.0f} m behind it",
                                   0.5 * scenario.vehicle.bogie_distance + 3.0 * scenario.smoothing + 2.0)});
      }
    }
    for (Stop s : profile->stops()) world->stops.push_back({time + s.from, time + s.to, s.distance});
    const double end = time + profile->duration();
    stop += stage.legs.size();
    world->pieces.push_back(
        {time, end, std::move(*profile), std::move(body), [path, ids, offset = stage.offset](double x) {
           const auto place = path->place(x - offset);
           return LinePlace{0.0, (*ids)[place.index], place.distance};
         }});
    time = end;
  }
  world->duration = time;
  complete(*world);
  return world;
}

}  // namespace versine::simulation

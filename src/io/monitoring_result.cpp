// SPDX-License-Identifier: Apache-2.0
#include "versine/io/monitoring_result.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "hdf5_columns.hpp"
#include "versine/core/units.hpp"

namespace versine::io {

namespace {
using Kind = Hdf5Columns::Kind;

std::vector<Hdf5Columns::Column> stamp_columns() {
  return {{"time_ns", Kind::integer},      {"sample", Kind::real},           {"journey", Kind::integer},
          {"track", Kind::integer},        {"track_distance_m", Kind::real}, {"mileage_m", Kind::real},
          {"path_distance_m", Kind::real}, {"latitude_deg", Kind::real},     {"longitude_deg", Kind::real},
          {"speed_mps", Kind::single},     {"sigma_m", Kind::single},        {"probability", Kind::single}};
}

std::vector<Hdf5Columns::Column> bin_columns(const std::vector<std::string>& channels) {
  std::vector<Hdf5Columns::Column> out{
      {"journey", Kind::integer}, {"track", Kind::integer},      {"from_m", Kind::real},
      {"to_m", Kind::real},       {"time_ns", Kind::integer},    {"speed_mps", Kind::single},
      {"sigma_m", Kind::single},  {"probability", Kind::single}, {"samples", Kind::integer}};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    for (const char* what : {"rms", "mean", "peak"}) out.push_back({fmt::format("{}_{}", what, c + 1), Kind::single});
    out.push_back({fmt::format("peak_at_m_{}", c + 1), Kind::real});
  }
  return out;
}

bool text_list(hid_t file, const char* name, const std::vector<std::string>& list) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  const hsize_t size = list.size();
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Hdf5Handle options = untimed_dataset();
  const Hdf5Handle set(H5Dcreate2(file, name, type, space, H5P_DEFAULT, options, H5P_DEFAULT), H5Dclose);
  std::vector<const char*> pointers;
  for (const auto& s : list) pointers.push_back(s.c_str());
  return set >= 0 && (list.empty() || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) >= 0);
}
}  // namespace

struct MonitoringResult::Impl {
  std::filesystem::path path;
  Hdf5Handle file;
  const georef::Map& map;
  Hdf5Columns table, positions, metres;
  std::map<std::string, std::int64_t> lines;
  std::vector<std::string> names;

  /// Lines of the map by number: a text a row would cost more than all the rest.
  std::int64_t line(network::TrackIndex track) {
    const auto& id = map.network.tracks[track].line_id;
    const auto [it, fresh] = lines.emplace(id, static_cast<std::int64_t>(names.size()));
    if (fresh) names.push_back(id);
    return it->second;
  }

  void row(Hdf5Columns& to, const georef::StampRow& r) {
    const auto& p = r.position;
    const auto g = map.network.to_geodetic(p.point);
    to.put(r.time.ns), to.put(r.sample), to.put(static_cast<std::int64_t>(p.journey) + 1), to.put(line(p.track.track));
    to.put(p.track_distance), to.put(p.mileage.value_or(NAN)), to.put(p.path_distance);
    to.put(g.latitude / units::deg), to.put(g.longitude / units::deg);
    to.put(p.speed), to.put(p.sigma), to.put(p.probability);
    to.end_row();
  }

  void row(const georef::BinRow& b) {
    metres.put(static_cast<std::int64_t>(b.journey) + 1), metres.put(line(b.track));
    metres.put(b.from), metres.put(b.to), metres.put(b.time.ns), metres.put(b.speed), metres.put(b.sigma);
    metres.put(b.probability), metres.put(static_cast<std::int64_t>(b.samples));
    for (const auto& c : b.channels) metres.put(c.rms), metres.put(c.mean), metres.put(c.peak), metres.put(c.peak_at);
    metres.end_row();
  }
};

MonitoringResult::MonitoringResult(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MonitoringResult::MonitoringResult(MonitoringResult&&) noexcept = default;
MonitoringResult::~MonitoringResult() = default;

Expected<MonitoringResult> MonitoringResult::create(const std::filesystem::path& path, const std::string& source,
                                                    const georef::Map& map, const std::vector<std::string>& channels) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  Hdf5Handle file(H5Fcreate(path.string().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  if (file < 0 || !text_list(file, "channels", channels) || !text_list(file, "source", {source})) {
    return fail({.file = path.string(),
                 .found = "a file that cannot be written",
                 .expected = "a writable place with free space",
                 .advice = "check permissions and free space"});
  }
  Hdf5Columns table(file, "table", stamp_columns()), positions(file, "positions", stamp_columns()),
      metres(file, "metres", bin_columns(channels));
  return MonitoringResult(std::unique_ptr<Impl>(
      new Impl{path, std::move(file), map, std::move(table), std::move(positions), std::move(metres), {}, {}}));
}

void MonitoringResult::take(georef::MonitoringStamper& stamper) {
  for (const auto& r : stamper.table) impl_->row(impl_->table, r);
  for (const auto& r : stamper.positions) impl_->row(impl_->positions, r);
  for (const auto& b : stamper.bins) impl_->row(b);
  stamper.table.clear(), stamper.positions.clear(), stamper.bins.clear();
}

Expected<void> MonitoringResult::close() {
  bool good = text_list(impl_->file, "tracks", impl_->names);
  for (Hdf5Columns* c : {&impl_->table, &impl_->positions, &impl_->metres}) {
    c->flush();
    good = good && c->good();
  }
  if (good && H5Fflush(impl_->file, H5F_SCOPE_LOCAL) >= 0) return {};
  return fail({.file = impl_->path.string(),
               .found = "a file that cannot be written whole",
               .expected = "space on the disk",
               .advice = "free some space"});
}

}  // namespace versine::io

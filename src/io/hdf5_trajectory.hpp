// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hdf5_file.hpp"
#include "versine/core/time.hpp"
#include "versine/io/write_trajectory.hpp"

namespace versine::io {

/// Dataset of times: integer nanoseconds, with the epoch as attribute.
void write_times(Hdf5File& file, const std::string& name, const std::vector<std::int64_t>& nanoseconds,
                 TimeScale scale);
template <class List, class TimeOf>
void write_times(Hdf5File& file, const std::string& name, const List& list, TimeScale scale, TimeOf time_of) {
  std::vector<std::int64_t> times;
  times.reserve(list.size());
  for (const auto& item : list) times.push_back(time_of(item).ns);
  write_times(file, name, times, scale);
}

/// A group with the columns of trajectory.h5.
void write_trajectory_group(Hdf5File& file, const std::string& group, const geodesy::Trajectory& trajectory,
                            const TrajectoryOutput& output);

}  // namespace versine::io

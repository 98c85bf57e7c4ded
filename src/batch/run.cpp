// SPDX-License-Identifier: Apache-2.0
#include "versine/batch/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>

namespace versine::batch {

namespace {
int bucket(const std::string& unit, int count) {
  std::uint64_t value = 0;
  std::from_chars(unit.data(), unit.data() + std::min<std::size_t>(16, unit.size()), value, 16);
  return static_cast<int>(value % static_cast<std::uint64_t>(count));
}

Outcome<Done::State> execute(const Store& store, const Unit& unit, const Stage& stage) {
  auto made = stage(unit);
  if (!made) return tl::unexpected(made.error());
  Receipt receipt{unit.unit, {}, made->rejection};
  if (!made->rejection) {
    for (const auto& file : made->files) {
      auto name = store.put(file.bytes);
      if (!name) return tl::unexpected(name.error());
      receipt.outputs.push_back({file.name, *name, file.bytes.size()});
    }
  }
  const auto committed = commit(store, receipt);
  if (!committed) return tl::unexpected(committed.error());
  if (*committed == Commit::duplicate) return Done::State::duplicate;
  return receipt.rejection ? Done::State::rejected : Done::State::done;
}
}  // namespace

const char* to_string(Done::State state) {
  switch (state) {
    case Done::State::done:
      return "done";
    case Done::State::rejected:
      return "rejected";
    case Done::State::duplicate:
      return "duplicate";
    case Done::State::skipped:
      return "skipped";
    case Done::State::failed:
      return "failed";
  }
  return "failed";
}

Outcome<std::vector<std::size_t>> select_units(const Store& store, const Manifest& m, const Selection& s) {
  const Shard shard = s.shard.value_or(Shard{});
  if (s.shard &&
      (shard.count < 1 || shard.index < 0 || shard.index >= shard.count || (!s.missing && shard.count != m.shards))) {
    return failure(Exit::usage, {.field = "shard",
                                 .found = fmt::format("shard {} of {}", shard.index, shard.count),
                                 .expected = fmt::format("0 to {} of {}", m.shards - 1, m.shards),
                                 .advice = "a sweep (--missing) may be split otherwise than the manifest"});
  }
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < m.units.size(); ++i) {
    const Unit& u = m.units[i];
    const int in = s.missing ? bucket(u.unit, shard.count) : u.shard;
    if ((s.shard && in != shard.index) || has_receipt(store, u.unit)) continue;
    out.push_back(i);
  }
  std::sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) {
    return m.units[a].weight != m.units[b].weight ? m.units[a].weight > m.units[b].weight : a < b;
  });
  return out;
}

Exit run_units(const Store& store, const Manifest& m, const Stage& stage,
               const std::function<std::optional<std::size_t>()>& next, const std::function<bool()>& cancelled,
               const std::function<void(const Done&)>& told) {
  using Clock = std::chrono::steady_clock;
  Exit exit = Exit::done;
  while (const auto index = next()) {
    if (cancelled()) return graver(exit, Exit::again);
    const Unit& unit = m.units[*index];
    Done done{*index};
    const auto begin = Clock::now();
    if (has_receipt(store, unit.unit)) {
      done.state = Done::State::skipped;  // another worker was faster
    } else if (auto state = execute(store, unit, stage)) {
      done.state = *state;
    } else {
      done.state = Done::State::failed;
      done.failure = std::move(state.error());
      exit = graver(exit, done.failure->exit);
    }
    done.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    told(done);
    if (done.failure && (done.failure->exit == Exit::again || done.failure->exit == Exit::configuration)) return exit;
  }
  return exit;
}

Exit after_attempts(Exit exit, int attempt) {
  return exit == Exit::again && attempt >= 5 ? Exit::failed : exit;
}

}  // namespace versine::batch

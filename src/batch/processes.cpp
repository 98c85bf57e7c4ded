// SPDX-License-Identifier: Apache-2.0
#include "versine/batch/processes.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <atomic>
#include <cstdio>
#include <new>
#include <vector>

namespace versine::batch {

namespace {
struct Counters {
  std::atomic<std::size_t> taken{0}, done{0};
};

/// Counters in memory that forked processes share.
class Shared {
 public:
  Shared() {
    void* p = mmap(nullptr, sizeof(Counters), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (p == MAP_FAILED) throw std::bad_alloc();
    counters_ = new (p) Counters;
  }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  ~Shared() { munmap(counters_, sizeof(Counters)); }
  Counters* operator->() const { return counters_; }

 private:
  Counters* counters_;
};

pid_t start(const std::function<Exit(const WorkQueue&)>& worker, const WorkQueue& queue) {
  std::fflush(nullptr);
  const pid_t parent = getpid(), child = fork();
  if (child != 0) return child;
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // a worker stops soon after its master was killed
  if (getppid() != parent) _exit(static_cast<int>(Exit::again));
#else
  static_cast<void>(parent);
#endif
  Exit exit = Exit::again;
  try {
    exit = worker(queue);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "versine: %s\n", e.what());
  }
  std::fflush(nullptr);
  _exit(static_cast<int>(exit));
}
}  // namespace

Exit run_processes(int processes, std::size_t count, const std::function<Exit(const WorkQueue&)>& worker,
                   const std::function<bool(std::size_t)>& watch) {
  const Shared shared;
  const WorkQueue queue{[&]() -> std::optional<std::size_t> {
                          const std::size_t i = shared->taken++;
                          return i < count ? std::optional(i) : std::nullopt;
                        },
                        [&] {
                          ++shared->done;
                          if (processes == 1) static_cast<void>(watch(shared->done));
                        }};
  if (processes == 1) return worker(queue);
  std::vector<pid_t> alive;
  Exit exit = Exit::done;
  for (int i = 0; i < processes; ++i) {
    if (const pid_t child = start(worker, queue); child > 0) {
      alive.push_back(child);
    } else {
      exit = Exit::again;
    }
  }
  bool asked = false;
  while (!alive.empty()) {
    std::erase_if(alive, [&](pid_t child) {
      int status = 0;
      const pid_t ended = waitpid(child, &status, WNOHANG);
      if (ended == 0 || (ended < 0 && errno == EINTR)) return false;
      exit = graver(exit, WIFEXITED(status) ? static_cast<Exit>(WEXITSTATUS(status)) : Exit::again);
      return true;
    });
    if (!watch(shared->done) && !asked) {
      asked = true;
      for (const pid_t child : alive) kill(child, SIGTERM);
    }
    const timespec pause{0, 50'000'000};
    if (!alive.empty()) nanosleep(&pause, nullptr);
  }
  return exit;
}

}  // namespace versine::batch

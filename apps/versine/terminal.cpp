// SPDX-License-Identifier: Apache-2.0
#include "terminal.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace versine::cli {

namespace {
volatile std::sig_atomic_t interrupted = 0;
void on_signal(int) { interrupted = 1; }
}  // namespace

TerminalProgress::TerminalProgress(bool quiet) : shown_(!quiet && isatty(STDERR_FILENO) != 0) {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

TerminalProgress::~TerminalProgress() {
  if (shown_ && !stage_.empty()) std::fputs("\r\033[K", stderr);
}

void TerminalProgress::report(std::string_view stage, double fraction) {
  if (!shown_) return;
  const auto now = Clock::now();
  if (stage != stage_) {
    stage_ = stage;
    started_ = now;
  } else if (now - drawn_ < std::chrono::milliseconds(100) && fraction < 1.0) {
    return;
  }
  drawn_ = now;
  const double spent = std::chrono::duration<double>(now - started_).count();
  const double left = fraction > 0.02 ? spent * (1.0 - fraction) / fraction : 0.0;
  std::fprintf(stderr, "\r\033[K%s %3.0f %%", stage_.c_str(), 100.0 * fraction);
  if (left >= 1.0) std::fprintf(stderr, ", %.0f s left", left);
  std::fflush(stderr);
}

bool TerminalProgress::cancelled() const { return interrupted != 0; }

void TerminalLog::info(std::string_view text) {
  if (!quiet_) std::fprintf(stderr, "\r%.*s\n", static_cast<int>(text.size()), text.data());
}

void TerminalLog::warn(std::string_view text) {
  std::fprintf(stderr, "\rwarning: %.*s\n", static_cast<int>(text.size()), text.data());
}

}  // namespace versine::cli

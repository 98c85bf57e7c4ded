// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace versine {

/// How a long computation reports, and learns that it should stop. Passed in by the caller; the library never prints.
class Progress {
 public:
  virtual ~Progress() = default;
  /// `stage` in the user's words ("forward pass"); `fraction` of it done, 0 to 1. Cheap enough for every 1,000 samples.
  virtual void report(std::string_view stage, double fraction) = 0;
  /// True when the user asked to stop; the computation then returns an Error with `found = "cancelled"`.
  [[nodiscard]] virtual bool cancelled() const { return false; }
};

/// Says nothing and never cancels.
class SilentProgress final : public Progress {
 public:
  void report(std::string_view, double) override {}
};

/// Where messages for a person go.
class Log {
 public:
  virtual ~Log() = default;
  virtual void info(std::string_view text) = 0;
  virtual void warn(std::string_view text) = 0;
};

class SilentLog final : public Log {
 public:
  void info(std::string_view) override {}
  void warn(std::string_view) override {}
};

}  // namespace versine

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <mutex>

#include "gnss_files.hpp"

namespace versine::app {

/// RTKLIB's rnx2rtkp on prepared files; several directions may run side by side.
class GnssEngine {
 public:
  GnssEngine(const GnssProcessing& g, const gnss_files::Files& files, const gnss_files::Workspace& workspace,
             std::filesystem::path program, Progress& progress);

  [[nodiscard]] const gnss::Options& options() const { return options_; }

  /// The base's position against its own code solution.
  Expected<void> check_base();

  /// `from` and `to`: share of the job's progress.
  Expected<Series<sensors::GnssSample>> solve(gnss::Direction direction, double from, double to);

 private:
  Expected<std::optional<Eigen::Vector3d>> base_by_code();
  Expected<Series<sensors::GnssSample>> run(const gnss::Options& options, gnss::Direction direction,
                                            const std::vector<std::vector<gnss_files::File>>& observations,
                                            const std::string& name, double seconds, double from, double to);
  void report(std::string_view line, const gnss_files::Span& span, gnss::Direction direction, double from, double to);

  const GnssProcessing& g_;
  const gnss_files::Files& files_;
  const gnss_files::Workspace& workspace_;
  std::filesystem::path program_;
  Progress& progress_;
  std::mutex mutex_;
  gnss::Options options_;
};

}  // namespace versine::app

// SPDX-License-Identifier: Apache-2.0
#include "versine/app/survey_job.hpp"

#include "versine/app/survey_config.hpp"
#include "versine/app/survey_input.hpp"

namespace versine::app {

namespace {
void describe_defaults(ConfigVisitor& v) {
  SurveyConfig config;
  describe(v, config);
}

Expected<std::vector<std::string>> check(const std::filesystem::path& job, std::span<const std::string> overrides) {
  const auto config = read_survey_config(job, overrides);
  if (!config) return tl::unexpected(config.error());
  SilentProgress progress;
  const auto input = read_survey_input(*config, job, progress);
  if (!input) return tl::unexpected(input.error());
  return describe_input(*input);
}
}  // namespace

const JobKind survey_job{"survey", "A recording of a trolley or vehicle becomes a trajectory with its uncertainty.",
                         describe_defaults, check};

}  // namespace versine::app

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

#include "job/text_table.hpp"
#include "versine/report/facts.hpp"
#include "versine/report/georef_report.hpp"
#include "versine/report/plan_report.hpp"
#include "versine/report/survey_report.hpp"

/// From the files of a result folder to what a report shows.
namespace versine::app {

/// run.json of a finished result. Fails, naming the cure, when the folder is missing, empty, half written, or of
/// another version.
[[nodiscard]] Expected<nlohmann::ordered_json> read_run(const std::filesystem::path& folder);

[[nodiscard]] report::Facts read_facts(const std::filesystem::path& folder, const nlohmann::ordered_json& run);
[[nodiscard]] Expected<report::SurveyReport> read_survey_report(const std::filesystem::path& folder,
                                                                const nlohmann::ordered_json& run);
[[nodiscard]] Expected<report::GeorefReport> read_georef_report(const std::filesystem::path& folder,
                                                                const nlohmann::ordered_json& run);
[[nodiscard]] Expected<report::PlanReport> read_plan_report(const std::filesystem::path& folder,
                                                            const nlohmann::ordered_json& run);

/// A table of the folder; empty when the file is not there.
[[nodiscard]] Expected<report::RawTable> read_raw(const std::filesystem::path& path, char delimiter = ',');
/// A number or a text of JSON for a person; nothing for null.
[[nodiscard]] std::string text_of(const nlohmann::ordered_json& value);

}  // namespace versine::app

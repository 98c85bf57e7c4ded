// SPDX-License-Identifier: Apache-2.0
// Simulated journeys of an in-service vehicle through georeferencing against the truth: a table of accuracy, a table
// and a diagram of how often paths of a given probability are right.
// versine_georef_accuracy [--journeys 500] [--threads 2] [--data FOLDER] [--svg FILE] [--only NAME] [--verbose]
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <thread>

#include "georef_journeys.hpp"

using namespace versine;
using namespace versine::benchmarks;

namespace {

struct Arguments {
  std::uint64_t journeys = 500;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::string data = VERSINE_SOURCE "/../shared/data", svg, only;
  bool verbose = false;
};

Arguments parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const auto is = [&](const char* name) { return std::strcmp(argv[i], name) == 0 && i + 1 < argc; };
    if (is("--journeys")) {
      a.journeys = std::strtoull(argv[++i], nullptr, 10);
    } else if (is("--threads")) {
      a.threads = std::atoi(argv[++i]);
    } else if (is("--data")) {
      a.data = argv[++i];
    } else if (is("--svg")) {
      a.svg = argv[++i];
    } else if (is("--only")) {
      a.only = argv[++i];
    } else {
      a.verbose = true;
    }
  }
  return a;
}

/// The last is so poor that paths are in doubt: what calibration is judged by.
const Receiver receivers[] = {{"1 m, 15 s", 0.45, 0.9, 15.0, 15.0, true, true},
                              {"1 m, 15 s, no IMU", 0.45, 0.9, 15.0, 15.0, false, false},
                              {"1 m, 60 s, job says 15 s", 0.45, 0.9, 60.0, 15.0, true, true},
                              {"3 m, 15 s", 1.35, 2.7, 15.0, 15.0, true, true},
                              {"3 m, 15 s, no IMU", 1.35, 2.7, 15.0, 15.0, false, false}};

void print_row(const std::string& place, const std::string& receiver, const Score& s) {
  const auto n = static_cast<double>(s.n_good + s.n_bad), count = static_cast<double>(s.journeys);
  fmt::print("| {} | {} | {} | {:.2f} % | {:.3f} m | {:.3f} m | {:.1f} % | {:.2f} | {:.1f} | {:.1f} ms |\n", place,
             receiver, s.journeys, 100.0 * static_cast<double>(s.right) / count,
             std::sqrt(s.square_good / static_cast<double>(s.n_good)),
             std::sqrt(s.square_bad / static_cast<double>(s.n_bad)), 100.0 * static_cast<double>(s.inside) / n,
             s.normalised / n, static_cast<double>(s.hypotheses) / count, 1000.0 * s.seconds / count);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments a = parse(argc, argv);
  std::vector<Place> places{harbour()};
  if (auto more = utrecht(a.data)) {
    places.push_back(std::move(*more));
  } else {
    fmt::print("{}\n", more.error().message());
  }
  report::Figure figure{.title = "Are paths as probable as they say?",
                        .x = {"probability told", 0.0, 1.0, false},
                        .y = {"share that was right", 0.0, 1.0, false},
                        .curves = {{"ideal", {0.0, 1.0}, {0.0, 1.0}, report::CurveStyle::dashed, 7}},
                        .field = {}};
  fmt::print(
      "| network | GNSS error | journeys | right path | along, RMS, GNSS good | within 10 s of a bridge | 95 % "
      "interval "
      "covers | NEES | paths | CPU a journey |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  std::string paths, switches;
  for (const auto& place : places) {
    if (place.name.find(a.only) == std::string::npos) continue;
    const auto scores = drive(place, receivers, a.journeys, a.threads, a.verbose);
    for (std::size_t i = 0; i < scores.size(); ++i) {
      print_row(place.name, receivers[i].name, scores[i]);
      auto of_paths = reliability(place.name + ", " + receivers[i].name, scores[i].paths);
      paths += of_paths.rows;
      switches += reliability(place.name + ", " + receivers[i].name, scores[i].switches).rows;
      figure.curves.push_back(std::move(of_paths.curve));
    }
  }
  const char* head = "probability told | how many | told, mean | right |\n| --- | --- | --- | --- | --- |\n";
  fmt::print("\n| paths of | {}{}\n| switches of | {}{}", head, paths, head, switches);
  if (!a.svg.empty()) std::ofstream(a.svg) << report::to_svg(figure);
}

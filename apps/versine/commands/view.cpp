// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "command.hpp"
#include "versine/app/view_model.hpp"
#include "versine/core/process.hpp"

namespace versine::cli {

namespace {

volatile std::sig_atomic_t stopped = 0;

struct ViewOptions {
  std::vector<std::string> results;
  std::string compare;
  std::string background;
  int port = 0;
  bool no_browser = false;
};

/// Opens the address where there is a display; elsewhere a person copies what was printed.
void open_browser(const std::string& url) {
#ifdef __APPLE__
  const char* opener = "open";
#else
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  const char* opener = "xdg-open";
#endif
  const auto program = find_program(opener);
  const std::vector<std::string> arguments = {url};
  if (program) (void)run_process(*program, arguments, [](std::string_view) { return true; });
}

int view(const ViewOptions& options) {
  std::optional<std::filesystem::path> compare;
  if (options.results.size() > 1) compare = options.results[1];
  if (!options.compare.empty()) compare = options.compare;
  std::optional<std::filesystem::path> background;
  if (!options.background.empty()) background = options.background;
  auto content = app::follow_view(options.results.front(), compare, background);
  if (!content) return report(content.error());
  const auto server = app::ViewServer::start(std::move(*content), {.port = options.port, .token = {}});
  if (!server) return report(server.error());
  std::printf("%s\nThe page is for this computer only. Ctrl+C ends it.\n", server->url().c_str());
  std::fflush(stdout);
  std::signal(SIGINT, [](int) { stopped = 1; });
  std::signal(SIGTERM, [](int) { stopped = 1; });
  if (!options.no_browser) open_browser(server->url());
  server->wait([] { return stopped != 0; });
  return good;
}

}  // namespace

void add_view(CLI::App& app, int& exit) {
  auto* command = app.add_subcommand("view", "Look at a result in the browser, or at a job that is still running");
  auto options = std::make_shared<ViewOptions>();
  command->add_option("result", options->results, "Result folder; a second one is subtracted from it")
      ->required()
      ->expected(1, 2);
  command->add_option("--compare", options->compare, "The result that is subtracted");
  command->add_option("--background", options->background,
                      "Picture of the ground under the plan: GeoTIFF or MBTiles, in any CRS");
  command->add_option("--port", options->port, "Port on 127.0.0.1; 0 takes any free one")->check(CLI::Range(0, 65535));
  command->add_flag("--no-browser", options->no_browser, "Print the address only");
  command->callback([options, &exit] { exit = view(*options); });
}

}  // namespace versine::cli

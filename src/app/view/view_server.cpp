// SPDX-License-Identifier: Apache-2.0
#include "versine/app/view_server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>

#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

namespace versine::app {

namespace {

constexpr const char* host = "127.0.0.1";
// Charts and map set styles from script, so that inline styles must be allowed; scripts must be the page's own.
constexpr const char* policy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";
// The report is one file with its styles inside and no script at all.
constexpr const char* report_policy =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; font-src data:; frame-ancestors 'none'";

std::string random_token() {
  std::array<unsigned char, 32> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) return {};
  std::string text;
  for (const unsigned char b : bytes) text += fmt::format("{:02x}", b);
  return text;
}

bool same(const std::string& a, const std::string& b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::optional<double> number(const httplib::Request& request, const char* name) {
  if (!request.has_param(name)) return std::nullopt;
  const std::string text = request.get_param_value(name);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

void refuse(httplib::Response& response, int status, const char* why) {
  response.status = status;
  response.set_content(why, "text/plain; charset=utf-8");
}

/// The body as it is. Given as a string it would be compressed with Brotli's best quality, assets for the second time:
/// 50 ms each, and nothing gained on this computer.
void send(httplib::Response& response, std::string body, const char* type) {
  if (body.empty()) return response.set_content(body, type);
  const std::size_t size = body.size();
  response.set_content_provider(size, type,
                                [kept = std::move(body)](std::size_t offset, std::size_t length, auto& sink) {
                                  return sink.write(kept.data() + offset, length);
                                });
}

}  // namespace

struct ViewServer::Impl {
  ViewContent content;
  std::string token;
  int port = 0;
  httplib::Server server;
  std::thread thread;

  ~Impl() {
    server.stop();
    if (thread.joinable()) thread.join();
  }

  /// True when the request may not go on; the response then says why.
  bool guard(const httplib::Request& request, httplib::Response& response) const {
    const std::string own = fmt::format("{}:{}", host, port);
    if (request.get_header_value_count("Host") != 1 || request.get_header_value("Host") != own) {
      refuse(response, 421, "this server answers only to its own address");
      return true;
    }
    if (request.has_header("Origin") && request.get_header_value("Origin") != "http://" + own) {
      refuse(response, 403, "requests of other sites are refused");
      return true;
    }
    const std::string site = request.get_header_value("Sec-Fetch-Site");
    if (site == "cross-site" || site == "same-site") {
      refuse(response, 403, "requests of other sites are refused");
      return true;
    }
    const bool writes = request.method == "POST" && ((request.path == "/api/constraints" && content.put_constraints) ||
                                                     (request.path == "/api/marks" && content.put_marks));
    if (request.method != "GET" && request.method != "HEAD" && !writes) {
      response.set_header("Allow", "GET, HEAD");
      refuse(response, 405, "only GET and HEAD");
      return true;
    }
    if (request.path.starts_with("/api/")) {
      if (request.get_header_value_count("X-Versine-Token") != 1 ||
          !same(request.get_header_value("X-Versine-Token"), token)) {
        refuse(response, 401, "the address must be the one that versine view printed, with its token");
        return true;
      }
    }
    return false;
  }

  void serve_api() {
    server.Get("/api/result", [this](const httplib::Request&, httplib::Response& response) {
      send(response, content.result_json(), "application/json");
    });
    server.Get("/api/progress", [this](const httplib::Request&, httplib::Response& response) {
      send(response, content.progress_json ? content.progress_json() : "{}", "application/json");
    });
    server.Get("/api/values", [this](const httplib::Request& request, httplib::Response& response) {
      const auto x = number(request, "x");
      if (!content.values_json || !x) return refuse(response, 404, "no such place in this result");
      send(response, content.values_json(*x), "application/json");
    });
    server.Get(
        R"(/api/series/([A-Za-z0-9_:.%-]+))", [this](const httplib::Request& request, httplib::Response& response) {
          constexpr double infinity = std::numeric_limits<double>::infinity();
          const double buckets = number(request, "buckets").value_or(0.0);
          if (!content.series) return refuse(response, 404, "no such series in this result");
          const auto body = content.series(request.matches[1].str(), number(request, "from").value_or(-infinity),
                                           number(request, "to").value_or(infinity),
                                           buckets > 0.0 && buckets <= 1e7 ? static_cast<std::size_t>(buckets) : 0);
          if (!body) return refuse(response, 404, "no such series in this result");
          send(response, *body, "application/octet-stream");
        });
    server.Get(R"(/api/map/([A-Za-z0-9.]+))", [this](const httplib::Request& request, httplib::Response& response) {
      const auto body = content.map ? content.map(request.matches[1].str()) : std::nullopt;
      if (!body) return refuse(response, 404, "no such part of a map in this result");
      send(response, *body, "application/octet-stream");
    });
    server.Get("/api/background", [this](const httplib::Request& request, httplib::Response& response) {
      constexpr double infinity = std::numeric_limits<double>::infinity();
      std::array<double, 4> window{};
      const std::array<const char*, 4> edges{"west", "south", "east", "north"};
      for (std::size_t i = 0; i < 4; ++i) window[i] = number(request, edges[i]).value_or(infinity);
      const double width = number(request, "width").value_or(0.0), height = number(request, "height").value_or(0.0);
      const bool sound = window[0] < window[2] && window[1] < window[3] && window[2] < infinity &&
                         window[3] < infinity && width >= 1.0 && width <= 4096.0 && height >= 1.0 && height <= 4096.0;
      const auto png = sound && content.background
                           ? content.background(window, static_cast<int>(width), static_cast<int>(height))
                           : std::nullopt;
      if (!png) return refuse(response, 404, "no background here");
      send(response, *png, "image/png");
    });
    // The report needs the token, too; a link cannot send a header, so the page fetches it and opens it as a blob.
    server.Get("/api/report", [this](const httplib::Request&, httplib::Response& response) {
      const auto text = content.report ? content.report() : std::nullopt;
      if (!text) return refuse(response, 404, "this result has no report; make one with: versine report RESULT");
      response.set_header("Content-Security-Policy", report_policy);
      send(response, *text, "text/html; charset=utf-8");
    });
    server.Get("/api/constraints", [this](const httplib::Request&, httplib::Response& response) {
      send(response, content.constraints_json ? content.constraints_json() : "[]", "application/json");
    });
    server.Get("/api/marks", [this](const httplib::Request&, httplib::Response& response) {
      send(response, content.marks_json ? content.marks_json() : "[]", "application/json");
    });
    const auto take = [this](const char* path, const auto& put) {
      server.Post(path, [&put](const httplib::Request& request, httplib::Response& response) {
        if (!request.get_header_value("Content-Type").starts_with("application/json")) {
          return refuse(response, 415, "this is written as JSON");
        }
        const auto done = put(request.body);
        if (!done) return refuse(response, 422, done.error().message().c_str());
        response.status = 204;
      });
    };
    take("/api/constraints", content.put_constraints);
    take("/api/marks", content.put_marks);
  }

  void serve_assets() {
    for (const auto& [path, asset] : view_assets()) {
      const Asset* found = &asset;
      std::string pattern;
      for (const char c : path) pattern += c == '.' ? std::string("\\.") : std::string(1, c);
      server.Get(pattern, [found](const httplib::Request&, httplib::Response& response) {
        response.set_header("Content-Encoding", "gzip");
        send(response, std::string(found->gzip), std::string(found->type).c_str());
      });
    }
  }

  void configure() {
    server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                                {"Referrer-Policy", "no-referrer"},
                                {"Cross-Origin-Resource-Policy", "same-origin"},
                                {"Cache-Control", "no-store"}});
    server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      if (guard(request, response)) return httplib::Server::HandlerResponse::Handled;
      return httplib::Server::HandlerResponse::Unhandled;
    });
    server.set_post_routing_handler([](const httplib::Request&, httplib::Response& response) {
      if (!response.has_header("Content-Security-Policy")) response.set_header("Content-Security-Policy", policy);
    });
    // Idle keep-alive connections hold a thread each: with few threads a browser's spare ones block the page.
    server.new_task_queue = [] { return new httplib::ThreadPool(16); };
    server.set_keep_alive_timeout(1);
    // Header and body are written one after the other: waiting for the header's acknowledgement costs 40 ms an answer.
    server.set_tcp_nodelay(true);
    server.set_payload_max_length(4 << 20);
  }
};

Expected<ViewServer> ViewServer::start(ViewContent content, ViewAddress address) {
  if (view_assets().empty()) {
    return fail({.found = "a program that was built without the viewer",
                 .expected = "one with it",
                 .advice = "build again with node and npm installed (VERSINE_VIEWER=ON), or use versine report"});
  }
  auto impl = std::make_unique<Impl>();
  impl->content = std::move(content);
  impl->token = address.token.empty() ? random_token() : address.token;
  if (impl->token.empty()) return fail({.found = "no random numbers from the system"});
  impl->configure();
  impl->serve_api();
  impl->serve_assets();
  if (address.port != 0) {
    impl->port = impl->server.bind_to_port(host, address.port) ? address.port : -1;
  } else {
    impl->port = impl->server.bind_to_any_port(host);
  }
  if (impl->port <= 0) {
    return fail({.field = "port",
                 .found = fmt::format("{} is taken or not permitted", address.port),
                 .expected = "a free port",
                 .advice = "leave --port away to take any free one"});
  }
  impl->thread = std::thread([server = &impl->server] { server->listen_after_bind(); });
  while (!impl->server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return ViewServer(std::move(impl));
}

ViewServer::ViewServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ViewServer::ViewServer(ViewServer&&) noexcept = default;
ViewServer::~ViewServer() = default;

std::string ViewServer::url() const {
  return fmt::format("http://{}:{}/#token={}", host, impl_->port, impl_->token);
}
int ViewServer::port() const {
  return impl_->port;
}
const std::string& ViewServer::token() const {
  return impl_->token;
}

void ViewServer::wait(const std::function<bool()>& stop) const {
  while (!stop()) std::this_thread::sleep_for(std::chrono::milliseconds(200));
}

}  // namespace versine::app

// SPDX-License-Identifier: Apache-2.0
#include "versine/app/view_server.hpp"

#include <gtest/gtest.h>
#include <httplib.h>

namespace versine::app {
namespace {

// The door's rules, one by one: each is an attack that must fail.
class ViewServerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (view_assets().empty()) GTEST_SKIP() << "built without the viewer";
    ViewContent content;
    content.result_json = [] { return R"({"title":"x"})"; };
    content.series = [](const std::string& id, double, double, std::size_t) -> std::optional<std::string> {
      return id == "gauge" ? std::optional<std::string>("abc") : std::nullopt;
    };
    content.put_constraints = [this](const std::string& text) -> Expected<void> {
      if (text == "bad") return fail({.found = "bad constraints"});
      written = text;
      return {};
    };
    auto started = ViewServer::start(content);
    ASSERT_TRUE(started) << started.error().message();
    server = std::make_unique<ViewServer>(std::move(*started));
    client = std::make_unique<httplib::Client>("127.0.0.1", server->port());
  }
  httplib::Headers token() const { return {{"X-Versine-Token", server->token()}}; }
  int get(const std::string& path, const httplib::Headers& headers) {
    auto response = client->Get(path.c_str(), headers);
    return response ? response->status : -1;
  }

  std::string written;
  std::unique_ptr<ViewServer> server;
  std::unique_ptr<httplib::Client> client;
};

TEST_F(ViewServerTest, GivesResultAndSeriesToItsOwnPage) {
  EXPECT_EQ(get("/api/result", token()), 200);
  EXPECT_EQ(get("/api/series/gauge?from=0&to=1&buckets=10", token()), 200);
  EXPECT_EQ(get("/api/series/other", token()), 404);
  const auto page = client->Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_NE(page->get_header_value("Content-Security-Policy").find("frame-ancestors 'none'"), std::string::npos);
}

TEST_F(ViewServerTest, RefusesWithoutOrWithAWrongToken) {
  EXPECT_EQ(get("/api/result", {}), 401);
  EXPECT_EQ(get("/api/result", {{"X-Versine-Token", "00"}}), 401);
  EXPECT_EQ(get("/api/result", {{"X-Versine-Token", server->token()}, {"X-Versine-Token", "00"}}), 401);
}

TEST_F(ViewServerTest, RefusesForeignHostAndOrigin) {
  for (const char* foreign : {"example.org", "localhost", "127.0.0.1"}) {
    auto headers = token();
    headers.emplace("Host", foreign);
    EXPECT_EQ(get("/api/result", headers), 421) << foreign;
  }
  auto origin = token();
  origin.emplace("Origin", "http://example.org");
  EXPECT_EQ(get("/api/result", origin), 403);
  auto site = token();
  site.emplace("Sec-Fetch-Site", "cross-site");
  EXPECT_EQ(get("/api/result", site), 403);
}

TEST_F(ViewServerTest, RefusesOtherMethodsButTheReviewersConstraints) {
  EXPECT_EQ(client->Post("/api/result", token(), "", "text/plain")->status, 405);
  EXPECT_EQ(client->Delete("/api/result", token())->status, 405);
  EXPECT_EQ(client->Post("/api/constraints", token(), "{}", "application/json")->status, 204);
  EXPECT_EQ(written, "{}");
  EXPECT_EQ(client->Post("/api/constraints", token(), "bad", "application/json")->status, 422);
  EXPECT_EQ(client->Post("/api/constraints", {}, "{}", "application/json")->status, 401);
  EXPECT_EQ(client->Post("/api/constraints", token(), "{}", "text/plain")->status, 415);
}

TEST_F(ViewServerTest, KnowsNoPathsOnDisk) {
  for (const char* path : {"/../etc/passwd", "/%2e%2e/etc/passwd", "/api/series/..%2f..%2fetc%2fpasswd", "//etc/passwd",
                           "/app.js/../run.json", "/run.json"}) {
    EXPECT_EQ(get(path, token()), 404) << path;
  }
}

TEST_F(ViewServerTest, EveryStartHasItsOwnToken) {
  auto other = ViewServer::start({.result_json = [] { return "{}"; }, .series = {}, .report = {}, .put_constraints = {}});
  ASSERT_TRUE(other);
  EXPECT_EQ(server->token().size(), 64u);
  EXPECT_NE(server->token(), other->token());
}

}  // namespace
}  // namespace versine::app

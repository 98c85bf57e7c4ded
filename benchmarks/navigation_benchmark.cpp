// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "fusion/scenario.hpp"
#include "versine/filter/kernels.hpp"
#include "versine/inertial/error_dynamics.hpp"

/// Kernels of navigation, and the whole engine in memory (no files): forward filter and smoother with odometer,
/// constraint and 1 Hz GNSS.
namespace versine {
namespace {

const test::Simulated& recording() {
  static const test::Simulated r = [] {
    test::Scenario s{.duration = 600.0, .wheel_lever = {0.0, 0.0, 0.0}};
    test::Simulated made = test::make(s, 1);
    made.options.constraint = true;
    return made;
  }();
  return r;
}

void mechanisation(benchmark::State& state) {
  const test::Simulated& r = recording();
  inertial::NavState nav = r.truth.truth.front();
  Eigen::Matrix3d C_nb = nav.q_nb.toRotationMatrix();
  inertial::StepGeometry geometry;
  std::size_t i = 0;
  for (auto _ : state) {
    const inertial::Increment increment = inertial::corrected(r.input.imu[i], 0.005, {});
    nav = inertial::mechanize(nav, increment, geodesy::wgs84, C_nb, geometry);
    i = (i + 1) % r.input.imu.size();
  }
  benchmark::DoNotOptimize(nav);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(mechanisation);

void mechanisation_with_transition(benchmark::State& state) {
  const test::Simulated& r = recording();
  inertial::NavState nav = r.truth.truth.front();
  Eigen::Matrix3d C_nb = nav.q_nb.toRotationMatrix();
  inertial::StepGeometry geometry;
  inertial::TransitionAccumulator transition;
  std::size_t i = 0;
  for (auto _ : state) {
    const inertial::Increment increment = inertial::corrected(r.input.imu[i], 0.005, {});
    nav = inertial::mechanize(nav, increment, geodesy::wgs84, C_nb, geometry);
    transition.add(geometry, increment);
    if (++i % 20 == 0) transition.reset();
    i %= r.input.imu.size();
  }
  benchmark::DoNotOptimize(transition);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(mechanisation_with_transition);

filter::Transition<23> transition() {
  filter::Transition<23> t;
  t.top.setRandom();
  t.top *= 0.01;
  t.top.leftCols<filter::moving>() += Eigen::Matrix<double, filter::moving, filter::moving>::Identity();
  t.decay.setOnes();
  t.noise.setConstant(1e-6);
  return t;
}

void predict(benchmark::State& state) {
  const filter::Transition<23> t = transition();
  filter::StateMatrix<23> P = filter::StateMatrix<23>::Identity();
  for (auto _ : state) {
    filter::StateMatrix<23> Q = P;
    filter::predict<23>(Q, t);
    benchmark::DoNotOptimize(Q);
  }
}
BENCHMARK(predict);

void update_row(benchmark::State& state) {
  const filter::StateMatrix<23> P = filter::StateMatrix<23>::Identity();
  const filter::StateVector<23> h = filter::StateVector<23>::Random();
  for (auto _ : state) {
    filter::StateMatrix<23> Q = P;
    filter::StateVector<23> x = filter::StateVector<23>::Zero();
    benchmark::DoNotOptimize(filter::update_row<23>(x, Q, h, 0.1, 1.0));
  }
}
BENCHMARK(update_row);

void rts_gain(benchmark::State& state) {
  const filter::Transition<23> t = transition();
  const filter::StateMatrix<23> P = filter::StateMatrix<23>::Identity();
  filter::StateMatrix<23> gain, predicted;
  for (auto _ : state) benchmark::DoNotOptimize(filter::rts_gain<23>(P, t, gain, predicted));
}
BENCHMARK(rts_gain);

/// Arguments: smoother (fusion::SmootherKind), covariance rate in Hz, output rate in Hz (0: every sample).
void engine(benchmark::State& state) {
  test::Simulated r = recording();
  r.options.smoother = static_cast<fusion::SmootherKind>(state.range(0));
  r.options.covariance_rate = static_cast<double>(state.range(1));
  r.options.output_rate = static_cast<double>(state.range(2));
  r.options.innovation_interval = 1.0;
  SilentProgress progress;
  SilentLog log;
  for (auto _ : state) benchmark::DoNotOptimize(fusion::run_aided_ins(r.input, r.options, progress, log));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(r.input.imu.size()));
}
BENCHMARK(engine)
    ->ArgNames({"smoother", "covariance_hz", "output_hz"})
    ->Args({0, 10, 10})
    ->Args({1, 10, 10})
    ->Args({2, 10, 10})
    ->Args({1, 20, 10})
    ->Args({1, 10, 0})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace versine

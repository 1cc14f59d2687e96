// The same from C++, with the fractions in a finite-volume loop of its own: heat that spreads through what is open.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>
#include <voidage.h>

namespace {

constexpr std::size_t nx = 12, ny = 6, nz = 6, cells = nx * ny * nz;
using Field = std::vector<double>;

// A call that refused becomes an exception.
void check(vdg_status status, const vdg_fault &fault) {
  if (status != VDG_STATUS_OK) {
    throw std::runtime_error(std::string(vdg_status_text(status)) + ": " + fault.argument);
  }
}

// One number for all bits of some results.
struct Hash {
  std::uint64_t value = 0;
  void mix(const double *values, std::size_t count) {
    for (std::size_t n = 0; n < count; ++n) {
      std::uint64_t bits;
      std::memcpy(&bits, &values[n], sizeof bits);
      value = (value << 7 | value >> 57) ^ bits;
    }
  }
  void mix(const Field &field) { mix(field.data(), field.size()); }
};

// Twelve triangles, counter-clockwise seen from outside.
void add_box(Field &corners, const std::array<double, 3> &low, const std::array<double, 3> &high) {
  constexpr int of[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                             {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto &triangle : of)
    for (int corner : triangle)
      for (std::size_t axis = 0; axis < 3; ++axis) corners.push_back(corner >> axis & 1 ? high[axis] : low[axis]);
}

struct Porosity {
  Field v = Field(cells), x = Field((nx + 1) * ny * nz), y = Field(nx * (ny + 1) * nz), z = Field(nx * ny * (nz + 1));
};

// docs: porosity
Porosity measure(const vdg_grid &grid, const vdg_surface &surface) {
  Porosity beta;
  vdg_fractions into{};
  into.value = {beta.v.data(), beta.x.data(), beta.y.data(), beta.z.data()};
  std::vector<std::byte> work(vdg_surface_work(&grid, &surface, nullptr));
  vdg_porosity_report found{};
  vdg_fault fault{};
  check(vdg_surface_porosity(&grid, &surface, nullptr, &into, work.data(), work.size(), &found, &fault), fault);
  return beta;
}
// docs: end

// docs: loop
// One step of heat that spreads through the open faces into the open volumes: d(beta_v T)/dt = div(beta_f grad T).
void spread(const Porosity &beta, Field &heat, double dt_over_dx_squared) {
  const Field old = heat;
  const auto cell = [](std::size_t i, std::size_t j, std::size_t k) { return (k * ny + j) * nx + i; };
  const auto exchange = [&](double open, std::size_t a, std::size_t b) {
    const double flux = open * (old[b] - old[a]) * dt_over_dx_squared;
    if (beta.v[a] > 0 && beta.v[b] > 0) {
      heat[a] += flux / beta.v[a];
      heat[b] -= flux / beta.v[b];
    }
  };
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t j = 0; j < ny; ++j)
      for (std::size_t i = 0; i < nx; ++i) {
        if (i > 0) exchange(beta.x[(k * ny + j) * (nx + 1) + i], cell(i - 1, j, k), cell(i, j, k));
        if (j > 0) exchange(beta.y[(k * (ny + 1) + j) * nx + i], cell(i, j - 1, k), cell(i, j, k));
        if (k > 0) exchange(beta.z[(k * ny + j) * nx + i], cell(i, j, k - 1), cell(i, j, k));
      }
}
// docs: end

// Heat that starts in one corner keeps its sum.
void own_loop(const Porosity &beta) {
  Field heat(cells);
  heat[0] = 1;
  const auto sum = [&] {
    double sum = 0;
    for (std::size_t n = 0; n < cells; ++n) sum += beta.v[n] * heat[n];
    return sum;
  };
  const double before = sum();
  double least = 1;
  for (double open : beta.v)
    if (open > 0) least = std::min(least, open);
  for (int step = 0; step < 100; ++step) spread(beta, heat, least / 8);
  if (!(sum() > before - 1e-12 && sum() < before + 1e-12) || !(heat[1] > 0)) throw std::runtime_error("heat was lost");
}

// docs: flow
std::array<Field, 5> ten_steps(const vdg_case &flow_case) {
  std::vector<std::byte> memory(vdg_flow_size(&flow_case));
  vdg_flow *flow = nullptr;
  vdg_fault fault{};
  check(vdg_flow_init(&flow_case, memory.data(), memory.size(), &flow, &fault), fault);
  const Field one(cells, 1.0);
  check(vdg_flow_set(flow, one.data(), nullptr, nullptr, nullptr, one.data(), &fault), fault);

  double rate = 0;
  check(vdg_flow_rate(flow, &rate, &fault), fault);
  for (int step = 0; step < 10; ++step) {
    vdg_step_report report{};
    check(vdg_flow_step(flow, 0.5 / rate, &report, &fault), fault);
    rate = report.rate;
  }
  std::array<Field, 5> state;
  for (Field &field : state) field.resize(cells);
  auto &[rho, u, v, w, p] = state;
  check(vdg_flow_get(flow, rho.data(), u.data(), v.data(), w.data(), p.data(), &fault), fault);
  return state;
}
// docs: end

void run() {
  Field x, y, corners;
  for (std::size_t i = 0; i <= nx; ++i) x.push_back(0.25 * static_cast<double>(i));
  for (std::size_t j = 0; j <= ny; ++j) y.push_back(0.25 * static_cast<double>(j));
  add_box(corners, {0.8, 0.35, 0.35}, {1.6, 1.1, 1.1});
  add_box(corners, {1.3, 0.6, 0.2}, {1.9, 0.9, 1.3});
  const std::array<std::size_t, 3> first = {0, 12, 24};
  const vdg_grid grid = {x.data(), y.data(), y.data(), nx, ny, nz};
  const vdg_surface surface = {corners.data(), 24, first.data(), 2, nullptr};
  const Porosity beta = measure(grid, surface);
  own_loop(beta);

  vdg_case flow_case{};
  flow_case.grid = grid;
  flow_case.gamma = 1.4;
  flow_case.beta_v = beta.v.data();
  flow_case.beta[0] = beta.x.data();
  flow_case.beta[1] = beta.y.data();
  flow_case.beta[2] = beta.z.data();
  flow_case.side[0] = {VDG_SIDE_FAR_FIELD, 1, {0.5, 0, 0}, 1, 0};
  flow_case.side[1] = {VDG_SIDE_OUTLET, 0, {0, 0, 0}, 1, 0};
  const std::array<Field, 5> state = ten_steps(flow_case);

  // docs: bodies
  vdg_body rod{}, block{};
  rod.kind = VDG_KIND_CAPSULE;
  block.kind = VDG_KIND_BOX;
  const double ends_and_radius[] = {0, 0, 0, 1, 2, 3, 0.25}, corners_of_block[] = {2, 0, 0, 3, 1, 1};
  std::copy(std::begin(ends_and_radius), std::end(ends_and_radius), rod.p);
  std::copy(std::begin(corners_of_block), std::end(corners_of_block), block.p);
  vdg_distance_report apart{};
  vdg_fault fault{};
  check(vdg_distance(&rod, &block, nullptr, &apart, &fault), fault);
  // docs: end

  Hash hash;
  for (const Field *field : {&beta.v, &beta.x, &beta.y, &beta.z}) hash.mix(*field);
  for (const Field &field : state) hash.mix(field);
  hash.mix(&apart.distance, 1);
  hash.mix(apart.a, 3);
  hash.mix(apart.b, 3);
  std::printf("hash %08lX%08lX\n", static_cast<unsigned long>(hash.value >> 32),
              static_cast<unsigned long>(hash.value & 0xffffffffu));
}

} // namespace

int main() {
  try {
    run();
  } catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

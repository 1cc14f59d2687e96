/* Porosity of two boxes made of triangles, ten steps of gas through it, and the distance of two bodies. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <voidage.h>

enum { NX = 12, NY = 6, NZ = 6, CELLS = NX * NY * NZ };

/* Stops with a sentence if a call refused. */
static void check(vdg_status status, const vdg_fault *fault) {
  if (status != VDG_STATUS_OK) {
    fprintf(stderr, "%s: %s, axis %d, entry %zu, %zu bytes needed\n", vdg_status_text(status), fault->argument,
            (int)fault->axis, fault->index, fault->needed);
    exit(1);
  }
}

/* One number for all bits of some results. */
static void mix(uint64_t *hash, const double *values, size_t count) {
  for (size_t n = 0; n < count; n++) {
    uint64_t bits;
    memcpy(&bits, &values[n], sizeof bits);
    *hash = (*hash << 7 | *hash >> 57) ^ bits;
  }
}

/* Twelve triangles, counter-clockwise seen from outside. */
static void box(double *corners, const double low[3], const double high[3]) {
  static const int of[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (int t = 0; t < 12; t++)
    for (int c = 0; c < 3; c++)
      for (int axis = 0; axis < 3; axis++)
        corners[9 * t + 3 * c + axis] = of[t][c] >> axis & 1 ? high[axis] : low[axis];
}

int main(void) {
  static double x[NX + 1], y[NY + 1], z[NZ + 1], corners[2 * 12 * 9];
  static double beta_v[CELLS], beta_x[(NX + 1) * NY * NZ], beta_y[NX * (NY + 1) * NZ], beta_z[NX * NY * (NZ + 1)];
  static double rho[CELLS], u[CELLS], v[CELLS], w[CELLS], p[CELLS];
  static const double low[2][3] = {{0.8, 0.35, 0.35}, {1.3, 0.6, 0.2}}, high[2][3] = {{1.6, 1.1, 1.1}, {1.9, 0.9, 1.3}};
  uint64_t hash = 0;
  vdg_fault fault;
  for (int i = 0; i <= NX; i++) x[i] = 0.25 * i;
  for (int j = 0; j <= NY; j++) y[j] = z[j] = 0.25 * j;
  for (int b = 0; b < 2; b++) box(corners + 108 * b, low[b], high[b]);

  /* docs: porosity */
  const size_t first[] = {0, 12, 24};
  const vdg_grid grid = {x, y, z, NX, NY, NZ};
  const vdg_surface surface = {.corners = corners, .triangles = 24, .first = first, .bodies = 2};
  const vdg_fractions beta = {.value = {beta_v, beta_x, beta_y, beta_z}};

  const size_t bytes = vdg_surface_work(&grid, &surface, NULL);
  void *work = malloc(bytes);
  vdg_porosity_report found;
  check(vdg_surface_porosity(&grid, &surface, NULL, &beta, work, bytes, &found, &fault), &fault);
  printf("solid volume %.15f\n", found.solid_volume);
  /* docs: end */
  free(work);

  /* docs: flow */
  vdg_case flow_case = {.grid = grid, .gas = VDG_GAS_IDEAL, .gamma = 1.4, .beta_v = beta_v, .beta = {beta_x, beta_y, beta_z}};
  flow_case.side[0] = (vdg_boundary){.kind = VDG_SIDE_FAR_FIELD, .rho = 1, .u = {0.5, 0, 0}, .p = 1};
  flow_case.side[1] = (vdg_boundary){.kind = VDG_SIDE_OUTLET, .p = 1};

  const size_t size = vdg_flow_size(&flow_case);
  void *memory = malloc(size);
  vdg_flow *flow;
  check(vdg_flow_init(&flow_case, memory, size, &flow, &fault), &fault);
  for (int cell = 0; cell < CELLS; cell++) rho[cell] = p[cell] = 1;
  check(vdg_flow_set(flow, rho, NULL, NULL, NULL, p, &fault), &fault);

  double rate;
  check(vdg_flow_rate(flow, &rate, &fault), &fault);
  for (int step = 0; step < 10; step++) {
    vdg_step_report report;
    check(vdg_flow_step(flow, 0.5 / rate, &report, &fault), &fault);
    rate = report.rate;
  }
  check(vdg_flow_get(flow, rho, u, v, w, p, &fault), &fault);
  /* docs: end */
  free(memory);

  /* docs: bodies */
  const vdg_body rod = {.kind = VDG_KIND_CAPSULE, .p = {0, 0, 0, 1, 2, 3, 0.25}};
  const vdg_body block = {.kind = VDG_KIND_BOX, .p = {2, 0, 0, 3, 1, 1}};
  vdg_distance_report apart;
  check(vdg_distance(&rod, &block, NULL, &apart, &fault), &fault);
  /* docs: end */

  mix(&hash, beta_v, CELLS);
  mix(&hash, beta_x, (NX + 1) * NY * NZ);
  mix(&hash, beta_y, NX * (NY + 1) * NZ);
  mix(&hash, beta_z, NX * NY * (NZ + 1));
  const double *const state[] = {rho, u, v, w, p};
  for (int n = 0; n < 5; n++) mix(&hash, state[n], CELLS);
  mix(&hash, &apart.distance, 1);
  mix(&hash, apart.a, 3);
  mix(&hash, apart.b, 3);
  printf("hash %08lX%08lX\n", (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffu));
  return 0;
}

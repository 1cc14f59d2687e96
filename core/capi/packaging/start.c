/* A program that brings nothing: what it leaves undefined, the archive asks for. It is linked, not run. */
#include <voidage.h>

typedef void (*function)(void);

void _start(void) {
  static const function all[] = {
      (function)vdg_surface_porosity, (function)vdg_scene_porosity, (function)vdg_meets, (function)vdg_distance,
      (function)vdg_flow_init,        (function)vdg_flow_set,       (function)vdg_flow_advance, (function)vdg_flow_totals,
      (function)vdgf_surface_porosity, (function)vdgf_scene_porosity, (function)vdgf_meets, (function)vdgf_distance,
      (function)vdgf_flow_init,       (function)vdgf_flow_set,      (function)vdgf_flow_advance, (function)vdgf_flow_totals};
  for (volatile size_t n = 0; n < sizeof all / sizeof *all; n++) all[n]();
}

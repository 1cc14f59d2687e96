//! Tests of the PDR Euler kernel: invariances to the bit, conservation, convergence, extremes, reference cases.

mod askew;
mod balance;
mod barotropic;
mod blast;
mod choking;
mod clusters;
mod contracts;
mod convergence;
mod drift;
mod edges;
mod extremes;
mod inclined;
mod invariance;
mod low_mach;
mod mixed;
mod narrowing;
mod patches;
mod plane_shocks;
mod reference;
mod repairs;
mod stress;
mod throat;
mod uneven;
mod vents;
mod wall_forces;
mod walls;

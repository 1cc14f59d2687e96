//! Steps of a flow along three axes, in a porous space with small cells, with one Riemann solver and one gas.
#![no_std]
#![no_main]

use voidage_core::flow::{OneFlux, WithEnergy, riemann::Hllc};

voidage_size::program!(voidage_size::flow::space::<OneFlux<Hllc, WithEnergy>>);

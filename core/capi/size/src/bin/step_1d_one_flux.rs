//! Steps of a flow along one axis, in open space, with one Riemann solver and one gas.
#![no_std]
#![no_main]

use voidage_core::flow::{OneFlux, WithEnergy, riemann::Hllc};

voidage_size::program!(voidage_size::flow::line::<OneFlux<Hllc, WithEnergy>>);

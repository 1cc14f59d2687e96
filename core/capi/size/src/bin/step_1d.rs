//! Steps of a flow along one axis, in open space, with whatever Riemann solver and gas.
#![no_std]
#![no_main]

use voidage_core::flow::AnyFlux;

voidage_size::program!(voidage_size::flow::line::<AnyFlux>);

//! Steps of a flow along three axes, in a porous space with small cells, with whatever Riemann solver and gas.
#![no_std]
#![no_main]

use voidage_core::flow::AnyFlux;

voidage_size::program!(voidage_size::flow::space::<AnyFlux>);

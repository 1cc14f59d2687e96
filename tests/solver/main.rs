//! Tests of the PDR Euler kernel.

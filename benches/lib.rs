//! Timing shared by the benchmarks.

//! Nothing: what each program takes by itself.
#![no_std]
#![no_main]

voidage_size::program!(voidage_size::any);

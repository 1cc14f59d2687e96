//! Runs all jobs in both precisions and prints a line for each: precision, job, hash; on the microcontroller also bytes of stack and thousands of
//! instructions.
#![cfg_attr(target_os = "none", no_std, no_main)]

mod api;
#[cfg(target_os = "none")]
mod board;
mod jobs;

#[cfg(not(target_os = "none"))]
fn main() {
    fn run<R: api::Api>(precision: &str) {
        // All zero bits are values of its arrays of numbers.
        let mut memory: Box<jobs::Memory<R>> = unsafe { Box::new_zeroed().assume_init() };
        for (name, job) in jobs::all() {
            println!("{precision} {name} {:016x}", job(&mut memory).0);
        }
    }
    run::<f32>("f32");
    run::<f64>("f64");
}

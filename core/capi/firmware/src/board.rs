//! The board: vectors, start, output and the timer of ARM's MPS2 with the image AN386, as QEMU has it.

use crate::api::Api;
use crate::jobs::{self, Memory};
use core::arch::{asm, global_asm};
use core::fmt::{self, Write};
use core::ptr::addr_of_mut;

global_asm!(
    ".section .vectors, \"a\"",
    ".word stack_top",
    ".word reset",
    ".rept 14",
    ".word fault",
    ".endr",
    ".text",
    ".thumb_func",
    ".global reset",
    "reset:",
    // The floating-point unit on.
    "ldr r0, =0xe000ed88",
    "ldr r1, [r0]",
    "orr r1, r1, #0xf00000",
    "str r1, [r0]",
    "dsb",
    "isb",
    "bl start",
    ".thumb_func",
    "fault:",
    "mov r0, #1",
    "bl leave",
    "b fault",
);

/// A call of the debugger that runs the board.
fn semihosting(operation: usize, argument: usize) {
    unsafe { asm!("bkpt 0xab", inout("r0") operation => _, in("r1") argument, options(nostack)) };
}

/// Ends the run.
#[unsafe(no_mangle)]
extern "C" fn leave(code: usize) -> ! {
    let block = [0x2_0026_usize, code];
    loop {
        semihosting(0x20, block.as_ptr() as usize);
    }
}

struct Console;

impl Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            semihosting(3, &raw const byte as usize);
        }
        Ok(())
    }
}

const TIMER: *mut u32 = 0x4000_0000 as *mut u32;

/// Counts down at 25 MHz of the board's time.
fn ticks() -> u32 {
    unsafe { TIMER.add(1).read_volatile() }
}

unsafe extern "C" {
    static mut data_start: u32;
    static mut data_end: u32;
    static data_load: u32;
    static mut bss_start: u32;
    static mut bss_end: u32;
}

/// What unused stack holds.
const PAINT: u32 = 0xa5a5_5a5a;

/// Stack that is watched, in words.
const WATCHED: usize = 64 << 10;

fn stack_pointer() -> *mut u32 {
    let at: *mut u32;
    unsafe { asm!("mov {}, sp", out(reg) at, options(nomem, nostack)) };
    at
}

/// Runs a job; its hash, bytes of stack and ticks. What the measuring itself takes is left out.
#[inline(never)]
fn measured<R>(job: fn(&mut Memory<R>) -> jobs::Hash, memory: &mut Memory<R>) -> (u64, usize, u32) {
    let top = stack_pointer().wrapping_sub(MARGIN);
    for n in 1..WATCHED {
        unsafe { top.sub(n).write_volatile(PAINT) };
    }
    let before = ticks();
    let hash = job(memory).0;
    let passed = before.wrapping_sub(ticks());
    let deepest = (1..WATCHED).rev().find(|&n| unsafe { top.sub(n).read_volatile() } != PAINT);
    (hash, deepest.unwrap_or(0) * 4, passed)
}

/// Words below the stack pointer that are not painted: the loop that paints may hold values there.
const MARGIN: usize = 16;

fn run<R: Api>(precision: &str, memory: *mut Memory<R>) {
    let memory = unsafe { &mut *memory };
    for (name, job) in jobs::all() {
        let (hash, stack, passed) = measured(job, memory);
        // An instruction takes a nanosecond of the board's time, a tick 40.
        let _ = writeln!(Console, "{precision} {name} {hash:016x} {stack} {}", u64::from(passed) * 40 / 1000);
    }
}

/// Memory of either precision, the larger one.
static mut MEMORY: core::mem::MaybeUninit<Memory<f64>> = core::mem::MaybeUninit::zeroed();

#[unsafe(no_mangle)]
unsafe extern "C" fn start() -> ! {
    unsafe {
        let (mut to, end, mut from) = (&raw mut data_start, &raw mut data_end, &raw const data_load);
        while to < end {
            to.write_volatile(from.read_volatile());
            (to, from) = (to.add(1), from.add(1));
        }
        let (mut to, end) = (&raw mut bss_start, &raw mut bss_end);
        while to < end {
            to.write_volatile(0);
            to = to.add(1);
        }
        TIMER.add(2).write_volatile(u32::MAX);
        TIMER.add(1).write_volatile(u32::MAX);
        TIMER.write_volatile(1);
        let memory = addr_of_mut!(MEMORY).cast::<u8>();
        run::<f32>("f32", memory.cast());
        memory.write_bytes(0, size_of::<Memory<f64>>());
        run::<f64>("f64", memory.cast());
    }
    leave(0)
}

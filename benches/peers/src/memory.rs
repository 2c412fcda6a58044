//! An allocator that can count: the largest number of bytes held at once.
//!
//! Counting is off while times are taken. Memory that is mapped without the allocator (fidget's
//! compiled code) is not seen.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicBool, AtomicIsize, Ordering::Relaxed};

struct Counting;

static ON: AtomicBool = AtomicBool::new(false);
static HELD: AtomicIsize = AtomicIsize::new(0);
static PEAK: AtomicIsize = AtomicIsize::new(0);

fn add(size: usize) {
    if ON.load(Relaxed) {
        let held = HELD.fetch_add(size.cast_signed(), Relaxed) + size.cast_signed();
        PEAK.fetch_max(held, Relaxed);
    }
}

fn remove(size: usize) {
    if ON.load(Relaxed) {
        HELD.fetch_sub(size.cast_signed(), Relaxed);
    }
}

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        remove(layout.size());
        unsafe { System.dealloc(block, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // A block that moves exists twice for a moment.
        add(size);
        let moved = unsafe { System.realloc(block, layout, size) };
        remove(layout.size());
        moved
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Runs `work`; the most bytes that it held at once, its result included.
pub fn peak_of<T>(work: impl FnOnce() -> T) -> (T, usize) {
    HELD.store(0, Relaxed);
    PEAK.store(0, Relaxed);
    ON.store(true, Relaxed);
    let result = work();
    ON.store(false, Relaxed);
    (result, PEAK.load(Relaxed).max(0).cast_unsigned())
}

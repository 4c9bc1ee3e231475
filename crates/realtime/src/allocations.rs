//! Counts what a thread allocates and frees once it is armed: a control cycle shall do neither.
//!
//! Programs install it with `#[global_allocator] static A: realtime::CountingAllocator = realtime::CountingAllocator;`.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct AllocationCounts {
    armed: Cell<bool>,
    allocations: Cell<u64>,
    frees: Cell<u64>,
}

thread_local! {
    // Const and without a destructor: usable inside of an allocator.
    static COUNTS: AllocationCounts =
        const { AllocationCounts { armed: Cell::new(false), allocations: Cell::new(0), frees: Cell::new(0) } };
}

/// The system allocator with a count per armed thread.
#[derive(Debug)]
pub struct CountingAllocator;

/// From here on, allocations of this thread are counted, from zero.
pub fn arm() {
    COUNTS.with(|c| {
        c.armed.set(true);
        c.allocations.set(0);
        c.frees.set(0);
    });
}

/// No longer.
pub fn disarm() {
    COUNTS.with(|c| c.armed.set(false));
}

/// Allocations and frees of this thread while armed. Always zero if the program did not install the allocator.
pub fn counted() -> [u64; 2] {
    COUNTS.with(|c| [c.allocations.get(), c.frees.get()])
}

fn count(which: impl Fn(&AllocationCounts) -> &Cell<u64>) {
    let _ = COUNTS.try_with(|c| {
        if c.armed.get() {
            let cell = which(c);
            cell.set(cell.get() + 1);
        }
    });
}

// SAFETY: every call goes unchanged to the system allocator, whose guarantees are handed on; counting touches two
// thread-local integers and allocates nothing.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(|c| &c.allocations);
        // SAFETY: the caller keeps the contract of `GlobalAlloc::alloc`, which is that of `System.alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, ptr: *mut u8, layout: Layout) {
        count(|c| &c.frees);
        // SAFETY: `ptr` came from `System` through this allocator, with this layout.
        unsafe { System.dealloc(ptr, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(|c| &c.allocations);
        // SAFETY: as for `alloc`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, ptr: *mut u8, layout: Layout, new_size: usize) -> *mut u8 {
        count(|c| &c.allocations);
        // SAFETY: as for `dealloc`; the caller vouches for `new_size`.
        unsafe { System.realloc(ptr, layout, new_size) }
    }
}

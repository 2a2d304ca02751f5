//! Processor time and memory of a piece of work.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

struct Counting;
static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

#[global_allocator]
static ALLOCATOR: Counting = Counting;

// SAFETY: the system's allocator does the work.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size(), Relaxed) + layout.size();
        PEAK.fetch_max(now, Relaxed);
        System.alloc(layout)
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        System.dealloc(at, layout);
    }
}

extern "C" {
    fn clock() -> std::ffi::c_long;
}

/// Processor time of this process [ms]; POSIX counts it in microseconds.
pub fn now() -> f64 {
    // SAFETY: takes nothing and touches nothing.
    unsafe { clock() as f64 * 1e-3 }
}

/// What work cost: least processor time of its repetitions [ms], peak memory above the start [MB].
pub struct Cost {
    pub ms: f64,
    pub megabytes: f64,
}

/// Repeat `work` for some tenths of a second, at least twice.
pub fn timed<T>(mut work: impl FnMut() -> T) -> (Cost, T) {
    let (begin, before) = (now(), NOW.load(Relaxed));
    PEAK.store(before, Relaxed);
    let mut least = f64::INFINITY;
    let mut repeat = || {
        let start = now();
        let out = work();
        least = least.min(now() - start);
        out
    };
    drop(repeat());
    while now() - begin < 300.0 {
        drop(repeat());
    }
    let out = repeat();
    let megabytes = (PEAK.load(Relaxed) - before) as f64 * 1e-6;
    let cost = Cost {
        ms: least,
        megabytes,
    };
    (cost, out)
}

//! RealtimeSanitizer over the armed cycle: where its runtime is preloaded (`tests/rtsan` does that), a call of the C library
//! that may allocate, lock or wait is reported with its stack. Otherwise nothing.

use std::ffi::CStr;
use std::sync::OnceLock;

/// The runtime's marks: the thread's cycle begins, and ends.
struct Marks {
    enter: extern "C" fn(),
    exit: extern "C" fn(),
}

static MARKS: OnceLock<Option<Marks>> = OnceLock::new();

/// Looks for the runtime, once for the process. Not in a cycle.
pub(crate) fn find() {
    MARKS.get_or_init(|| {
        Some(Marks { enter: mark(c"__rtsan_realtime_enter")?, exit: mark(c"__rtsan_realtime_exit")? })
    });
}

/// The thread's cycle begins.
pub(crate) fn enter() {
    if let Some(Some(marks)) = MARKS.get() {
        (marks.enter)();
    }
}

/// It ends.
pub(crate) fn exit() {
    if let Some(Some(marks)) = MARKS.get() {
        (marks.exit)();
    }
}

/// Function of this name among the libraries that are loaded.
fn mark(name: &CStr) -> Option<extern "C" fn()> {
    // SAFETY: `name` ends with a zero, and RTLD_DEFAULT searches what is loaded.
    let address = unsafe { libc::dlsym(libc::RTLD_DEFAULT, name.as_ptr()) };
    // SAFETY: the runtime declares both marks `void mark(void)`; a null pointer is `None` of this type.
    unsafe { std::mem::transmute::<*mut libc::c_void, Option<extern "C" fn()>>(address) }
}

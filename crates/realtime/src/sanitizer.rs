//! RealtimeSanitizer over the armed cycle: in a build with the feature `rtsan` a call of the C library that may allocate, lock
//! or wait is reported with its stack. Otherwise nothing; `tests/rtsan` makes that build and looks.

/// The thread's cycle begins.
pub(crate) fn enter() {
    #[cfg(feature = "rtsan")]
    rtsan_standalone::realtime_enter();
}

/// It ends.
pub(crate) fn exit() {
    #[cfg(feature = "rtsan")]
    rtsan_standalone::realtime_exit();
}

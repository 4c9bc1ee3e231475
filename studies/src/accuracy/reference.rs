//! The one reference of all methods on models with dry friction: semi-implicit steps, which solve the set-valued law, taken to
//! the limit of small steps.
//!
//! The method is of first order, so steps of h and 2 h give the limit 2 x(h) - x(2 h). How far that is from the limit by 2 h and
//! 4 h is an estimate of its error: four times too large where the second order is all that is left, too small where what
//! is left jumps with the step.

/// A quantity by steps of h, 2 h and 4 h: its limit by the first two, and by the last two.
pub(super) fn limits<T>([fine, middle, coarse]: &[T; 3], of: impl Fn(&T, &T) -> T) -> [T; 2] {
    [of(fine, middle), of(middle, coarse)]
}

/// 2 x(h) - x(2 h) of each number.
pub(super) fn limit(fine: &[f64], coarse: &[f64]) -> Vec<f64> {
    fine.iter().zip(coarse).map(|(f, c)| 2.0 * f - c).collect()
}

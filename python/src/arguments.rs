//! Arguments from Python: taken with their range, refused as a ValueError that names argument, value and range.
//!
//! A panic would leave a chain in the middle of a cycle, so nothing passes unchecked to what asserts lengths and finite numbers.

use messages::unknown;
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Most numbers of one argument or result: 800 MB.
pub(crate) const MOST_NUMBERS: usize = 100_000_000;
/// Greatest number of a state, a force or an acceleration in SI units.
pub(crate) const GREATEST: f64 = 1e6;

/// ValueError with this text.
pub(crate) fn wrong(text: impl ToString) -> PyErr {
    PyValueError::new_err(text.to_string())
}

/// ValueError of an unknown name, with those that are near; `hint` says where all of them are.
pub(crate) fn unknown_name<T: AsRef<str>>(kind: &str, name: &str, known: &[T], hint: &str) -> PyErr {
    let known: Vec<&str> = known.iter().map(AsRef::as_ref).collect();
    wrong(unknown(kind, name, &known, hint))
}

/// Value as somebody would type it, shortened.
fn shown(value: &Bound<'_, PyAny>) -> String {
    let text = value.repr().map_or_else(|_| "?".into(), |text| text.to_string());
    if text.chars().count() > 60 { text.chars().take(57).collect::<String>() + "..." } else { text }
}

/// A number in [low, high].
pub(crate) fn real(name: &str, value: &Bound<'_, PyAny>, [low, high]: [f64; 2], unit: &str) -> PyResult<f64> {
    let number = value.extract::<f64>().ok().filter(|x| *x >= low && *x <= high);
    number.ok_or_else(|| {
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        wrong(format!("{name} = {}: must be a number in [{low}, {high}]{unit}", shown(value)))
    })
}

/// A whole number in [low, high].
pub(crate) fn whole(name: &str, value: &Bound<'_, PyAny>, [low, high]: [u64; 2]) -> PyResult<u64> {
    let number = value.extract::<u64>().ok().filter(|n| (low..=high).contains(n));
    number
        .ok_or_else(|| wrong(format!("{name} = {}: must be a whole number in [{low}, {high}]", shown(value))))
}

/// An array of this shape, `usize::MAX` for any length, of numbers in [low, high]; anything that NumPy takes for one.
pub(crate) fn array(
    name: &str,
    value: &Bound<'_, PyAny>,
    shape: &[usize],
    [low, high]: [f64; 2],
) -> PyResult<Vec<f64>> {
    let wanted = || {
        let length = |n: &usize| if *n == usize::MAX { "any".into() } else { n.to_string() };
        shape.iter().map(length).collect::<Vec<String>>().join(" x ")
    };
    // Numbers at all, then shape, size and range.
    let numpy = value.py().import("numpy")?;
    let made = numpy.call_method1("asarray", (value, "float64")).ok();
    let array = made.as_ref().and_then(|made| made.cast::<PyArrayDyn<f64>>().ok()).ok_or_else(|| {
        wrong(format!("{name} = {}: must be an array of numbers, of shape {}", shown(value), wanted()))
    })?;
    let fits = |(n, wanted): (&usize, &usize)| *wanted == usize::MAX || n == wanted;
    if array.ndim() != shape.len() || !array.shape().iter().zip(shape).all(fits) {
        let has: Vec<String> = array.shape().iter().map(usize::to_string).collect();
        return Err(wrong(format!("{name} has the shape ({}): must be {}", has.join(", "), wanted())));
    }
    if array.len() > MOST_NUMBERS {
        return Err(wrong(format!("{name} has {} numbers: at most {MOST_NUMBERS}", array.len())));
    }
    let numbers: Vec<f64> = array.try_readonly().map_err(wrong)?.as_array().iter().copied().collect();
    match numbers.iter().position(|x| !(*x >= low && *x <= high)) {
        None => Ok(numbers),
        Some(i) => Err(wrong(format!("{name}[{i}] = {}: must lie in [{low}, {high}]", numbers[i]))),
    }
}

/// Three numbers in [low, high].
pub(crate) fn vector(name: &str, value: &Bound<'_, PyAny>, range: [f64; 2]) -> PyResult<[f64; 3]> {
    let numbers = array(name, value, &[3], range)?;
    Ok([numbers[0], numbers[1], numbers[2]])
}

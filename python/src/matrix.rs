//! Results as NumPy arrays, which own their numbers.

use nalgebra::{Dim, Matrix, RawStorage};
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;

/// Numbers in rows as an array of this shape.
pub(crate) fn table(
    py: Python<'_>,
    numbers: Vec<f64>,
    shape: Vec<usize>,
) -> PyResult<Bound<'_, PyArrayDyn<f64>>> {
    PyArray1::from_vec(py, numbers).reshape(shape)
}

/// A matrix.
pub(crate) fn matrix<'py, R: Dim, C: Dim, S: RawStorage<f64, R, C>>(
    py: Python<'py>,
    m: &Matrix<f64, R, C, S>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let numbers = m.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<f64>>()).collect();
    table(py, numbers, vec![m.nrows(), m.ncols()])
}

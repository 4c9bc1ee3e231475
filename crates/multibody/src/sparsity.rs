//! Sparsity of the mass matrix: the joints of different limbs do not meet.

use crate::body::Body;

/// For every degree of freedom the degrees of freedom from the base to it, itself last.
///
/// Row k of a symmetric matrix with the sparsity of the tree holds exactly these columns, so rows of this shape, one
/// after the other, are all there is of the mass matrix, and the row of an ancestor has the same columns as the
/// beginning of the row of its descendant.
#[derive(Clone, Debug, Default)]
pub(crate) struct Paths {
    /// First entry of each row; one more at the end.
    pub start: Vec<usize>,
    pub column: Vec<usize>,
    /// Places of an entry and its mirror image in the full matrix.
    pub full: Vec<[u32; 2]>,
}

impl Paths {
    pub(crate) fn new(bodies: &[Body]) -> Paths {
        let mut p = Paths::default();
        let mut rows: Vec<Vec<usize>> = (0..6).map(|k| (0..=k).collect()).collect();
        for (k, body) in bodies.iter().enumerate().skip(1) {
            let mut row = rows[body.parent + 5].clone();
            row.push(k + 5);
            rows.push(row);
        }
        for row in rows {
            p.start.push(p.column.len());
            p.column.extend(row);
        }
        p.start.push(p.column.len());
        let nv = p.start.len() - 1;
        for k in 0..nv {
            p.full.extend(
                p.column[p.start[k]..]
                    .iter()
                    .take(p.row(k).len())
                    .map(|c| [k + nv * c, c + nv * k].map(|i| i as u32)),
            );
        }
        p
    }

    /// Entries of a joint's row beyond the base's six.
    #[inline(always)]
    pub(crate) fn joints(&self, k: usize) -> std::ops::Range<usize> {
        self.start[k] + 6..self.start[k + 1]
    }

    #[inline(always)]
    pub(crate) fn row(&self, k: usize) -> std::ops::Range<usize> {
        self.start[k]..self.start[k + 1]
    }
}

/// For every body itself and the bodies it carries, each with the place of the pair's entry in the rows of [`Paths`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Subtrees {
    start: Vec<usize>,
    members: Vec<[u32; 2]>,
}

impl Subtrees {
    pub(crate) fn new(bodies: &[Body], paths: &Paths) -> Subtrees {
        let mut s = Subtrees::default();
        for k in 0..bodies.len() {
            s.start.push(s.members.len());
            for d in k.max(1)..bodies.len() {
                let row = paths.row(d + 5);
                if let Some(at) = paths.column[row.clone()].iter().position(|&c| k > 0 && c == k + 5) {
                    s.members.push([d as u32, (row.start + at) as u32]);
                }
            }
        }
        s.start.push(s.members.len());
        s
    }

    #[inline(always)]
    pub(crate) fn of(&self, k: usize) -> &[[u32; 2]] {
        &self.members[self.start[k]..self.start[k + 1]]
    }
}

//! Inner loops of the products with row-major matrices, compiled for the instruction set found at run time.
//!
//! Every product is a fused multiply-add in an order fixed by the shape alone, so results are the same on all
//! processors that have vector units of any width.

use faer::traits::pulp::{Arch, Simd, WithSimd};

/// Inner product over the shorter of the two lengths.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    Arch::new().dispatch(Dot { a, b })
}

/// y += s x over the shorter of the two lengths.
#[inline]
pub fn axpy(scale: f64, x: &[f64], y: &mut [f64]) {
    Arch::new().dispatch(Axpy { scale, x, y });
}

/// y += s A x for a matrix with rows of length `cols`.
pub(crate) fn add_product(scale: f64, a: &[f64], cols: usize, x: &[f64], y: &mut [f64]) {
    if let Some(x) = x.get(..cols.min(x.len())).filter(|x| !x.is_empty()) {
        Arch::new().dispatch(AddProduct { scale, a, cols, x, y });
    }
}

/// y += A^T x for a matrix with rows of length `cols`.
pub(crate) fn add_transposed_product(a: &[f64], cols: usize, x: &[f64], y: &mut [f64]) {
    let n = cols.min(y.len());
    if let Some(y) = y.get_mut(..n).filter(|y| !y.is_empty()) {
        Arch::new().dispatch(AddTransposedProduct { a, cols, x, y });
    }
}

struct Dot<'a> {
    a: &'a [f64],
    b: &'a [f64],
}

impl WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let n = self.a.len().min(self.b.len());
        dot_rows([&self.a[..n]], &self.b[..n])[0]
    }
}

struct Axpy<'a> {
    scale: f64,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for Axpy<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (y, x) in self.y.iter_mut().zip(self.x) {
            *y = x.mul_add(self.scale, *y);
        }
    }
}

struct AddProduct<'a> {
    scale: f64,
    a: &'a [f64],
    cols: usize,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for AddProduct<'_> {
    type Output = ();

    /// Four rows at a time share the loads of x and give enough independent chains of additions.
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { scale, a, cols, x, y } = self;
        // Without entries the number of columns may be any.
        if a.is_empty() {
            return;
        }
        let n = x.len();
        let mut a4 = a.chunks_exact(4 * cols);
        let mut y4 = y.chunks_exact_mut(4);
        for (quad, y) in (&mut y4).zip(&mut a4).map(|(y, quad)| (quad, y)) {
            let rows = [
                &quad[..n],
                &quad[cols..cols + n],
                &quad[2 * cols..2 * cols + n],
                &quad[3 * cols..3 * cols + n],
            ];
            let sums = dot_rows(rows, x);
            for k in 0..4 {
                y[k] = sums[k].mul_add(scale, y[k]);
            }
        }
        let done = (a.len() / cols).min(y.len()) / 4 * 4;
        for (y, row) in y.iter_mut().zip(a.chunks_exact(cols)).skip(done) {
            *y = dot_rows([&row[..n]], x)[0].mul_add(scale, *y);
        }
    }
}

struct AddTransposedProduct<'a> {
    a: &'a [f64],
    cols: usize,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl WithSimd for AddTransposedProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut from = 0;
        from = panels::<32>(self.a, self.cols, self.x, self.y, from);
        from = panels::<8>(self.a, self.cols, self.x, self.y, from);
        panels::<1>(self.a, self.cols, self.x, self.y, from);
    }
}

/// y += A^T x in panels of W columns held in registers, from column `from`; returns where it stopped.
#[inline(always)]
fn panels<const W: usize>(a: &[f64], cols: usize, x: &[f64], y: &mut [f64], mut from: usize) -> usize {
    while from + W <= y.len() {
        let mut sums = [0.0; W];
        sums.copy_from_slice(&y[from..from + W]);
        for (x, row) in x.iter().zip(a.chunks_exact(cols)) {
            let panel = &row[from..from + W];
            for k in 0..W {
                sums[k] = panel[k].mul_add(*x, sums[k]);
            }
        }
        y[from..from + W].copy_from_slice(&sums);
        from += W;
    }
    from
}

/// Inner products of R rows with x, each in eight interleaved partial sums: eight chains hide the latency of
/// the addition.
#[inline(always)]
fn dot_rows<const R: usize>(rows: [&[f64]; R], x: &[f64]) -> [f64; R] {
    let mut sums = [[0.0; 8]; R];
    let whole = x.len() / 8 * 8;
    let mut from = 0;
    while from < whole {
        let b = &x[from..from + 8];
        for r in 0..R {
            let a = &rows[r][from..from + 8];
            for k in 0..8 {
                sums[r][k] = a[k].mul_add(b[k], sums[r][k]);
            }
        }
        from += 8;
    }
    let mut result = [0.0; R];
    for r in 0..R {
        let [s0, s1, s2, s3, s4, s5, s6, s7] = sums[r];
        result[r] = ((s0 + s4) + (s2 + s6)) + ((s1 + s5) + (s3 + s7));
        for k in whole..x.len() {
            result[r] = rows[r][k].mul_add(x[k], result[r]);
        }
    }
    result
}

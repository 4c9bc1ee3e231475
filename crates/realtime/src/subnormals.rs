//! Subnormal numbers: whether arithmetic met any. Below 2.2e-308 it takes up to a hundred times as long, by the processor, and a
//! filter that decays stays there for ever.
//!
//! They are not flushed to zero: the compiler assumes the mode that a program starts with, and every result would depend on
//! who had set it. Instead the flags that x86-64 raises for them are read (MXCSR: denormal operand, underflow), and a test
//! holds that no cycle raises one.

/// Flags of MXCSR: denormal operand (bit 1), underflow (bit 4).
#[cfg(target_arch = "x86_64")]
const FLAGS: u32 = 1 << 1 | 1 << 4;

/// True if this thread computed with a subnormal number, or to one, since the last call; none where nobody can tell.
#[cfg(target_arch = "x86_64")]
#[inline(never)]
pub fn met() -> Option<bool> {
    let mut control = 0u32;
    // SAFETY: the register is stored to and loaded from a place of our own; only exception flags change, which no code relies on.
    unsafe {
        std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut control, options(nostack));
        let cleared = control & !FLAGS;
        std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const cleared, options(nostack));
    }
    Some(control & FLAGS != 0)
}

/// The same where nobody can tell.
#[cfg(not(target_arch = "x86_64"))]
pub fn met() -> Option<bool> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::hint::black_box;

    #[test]
    fn a_number_that_decays_is_noticed_where_it_becomes_subnormal() {
        if met().is_none() {
            return;
        }
        let mut x = black_box(1.0f64);
        let mut first = None;
        for cycle in 0..2000 {
            x = black_box(x * 0.5);
            if met() == Some(true) {
                first = first.or(Some(cycle));
            }
        }
        assert!(x == 0.0, "{x}");
        // 2^-1022 is the last normal number; half of it is exact, so it is the next one that is an operand.
        assert_eq!(first, Some(1023));
        assert_eq!((black_box(3.0) * black_box(0.25), met()), (0.75, Some(false)));
    }
}

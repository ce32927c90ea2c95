//! Taking several turns at once, so that taking turns does not slow down a loop of a few instructions.

use crate::Context;

/// Runs a loop as it is written, but takes the turns of `N` iterations at once. If fewer are left, it takes them one by one, so
/// that the loop stops at the same iteration as without the macro. `break`, `continue`, `return` and `?` work as in any loop.
///
/// The optimiser unrolls the strip of `N` iterations. With the feature `small`, or if code is optimised for size, turns are taken
/// one by one, which is shorter.
///
/// With a name after `N`, `strips!(8, few; …)`, the loop takes no turns if that variable is true.
///
/// ```
/// use staunch_runtime::{Context, Fault, FaultKind, OrFault, strips};
///
/// fn halve(cx: &Context, mut n: u32) -> Result<u32, Fault> {
///     let mut steps = 0;
///     strips!(8; while (n != 1) {
///         cx.take_turn().at(0, 3, 1)?;
///         n = if n % 2 == 0 { n / 2 } else { 3 * n + 1 };
///         steps += 1;
///     });
///     Ok(steps)
/// }
///
/// let cx = Context::at(0).with_turns(120);
/// assert_eq!(halve(&cx, 27).map_err(|it| it.kind), Ok(111));
/// assert_eq!(halve(&cx, 27).map_err(|it| it.kind), Err(FaultKind::LoopBudget));
/// ```
#[macro_export]
macro_rules! strips {
    ($n:literal, $few:ident; $($label:lifetime:)? while ($condition:expr) {
        $cx:ident.take_turn().at($($at:tt)*)?;
        $($body:tt)*
    }) => {
        // Two loops are faster than one, and longer.
        if $few && !$crate::Strips::<$n>::IS_SMALL {
            $($label:)? while $condition { $($body)* }
        } else {
            $crate::strips!(@ $cx, $n, {
                $($label:)? loop
            }, { if !$condition { break; } }, { if !$few { $cx.take_turn().at($($at)*)?; } }, { $($body)* })
        }
    };
    ($n:literal; $($label:lifetime:)? while ($condition:expr) {
        $cx:ident.take_turn().at($($at:tt)*)?;
        $($body:tt)*
    }) => {
        $crate::strips!(@ $cx, $n, {
            $($label:)? loop
        }, { if !$condition { break; } }, { $cx.take_turn().at($($at)*)?; }, { $($body)* })
    };
    ($n:literal; $($label:lifetime:)? loop {
        $cx:ident.take_turn().at($($at:tt)*)?;
        $($body:tt)*
    }) => {
        $crate::strips!(@ $cx, $n, {
            $($label:)? loop
        }, {}, { $cx.take_turn().at($($at)*)?; }, { $($body)* })
    };
    (@ $cx:ident, $n:literal, { $($head:tt)* }, { $($test:tt)* }, { $($turn:tt)* }, { $($body:tt)* }) => {
        'whole: {
            let mut strips = $crate::Strips::<$n>::new($cx);
            while strips.take() {
                'strip: {
                    $($head)* {
                        if strips.is_used() {
                            break 'strip;
                        }
                        $($test)*
                        strips.turn();
                        $($body)*
                    }
                    break 'whole;
                }
            }
            ::core::mem::drop(strips);
            $($head)* {
                $($test)*
                $($turn)*
                $($body)*
            }
        }
    };
}

/// The turns of a loop that takes `N` at once. Unused turns are returned to the context, however the loop ends.
#[derive(Debug)]
pub struct Strips<'a, const N: u64> {
    cx: &'a Context,
    /// The turns that the scan has left, without those of the strip.
    left: u64,
    /// The turns that are left of the strip.
    strip: u64,
}

impl<'a, const N: u64> Strips<'a, N> {
    /// Whether code should be short.
    pub const IS_SMALL: bool = cfg!(feature = "small");

    #[inline]
    pub fn new(cx: &'a Context) -> Self {
        Self { cx, left: cx.turns_left(), strip: 0 }
    }

    /// Takes a new strip after the previous one is used up. Returns whether enough turns were left.
    #[inline]
    pub fn take(&mut self) -> bool {
        let suffices = self.left >= N && !Self::IS_SMALL;
        if suffices {
            self.left -= N;
            self.strip = N;
        }
        suffices
    }

    #[inline]
    pub fn is_used(&self) -> bool {
        self.strip == 0
    }

    /// Takes one turn of a strip that is not used up.
    #[inline]
    pub fn turn(&mut self) {
        self.strip = self.strip.wrapping_sub(1);
    }
}

impl<const N: u64> Drop for Strips<'_, N> {
    #[inline]
    fn drop(&mut self) {
        self.cx.set_turns(self.left.wrapping_add(self.strip));
    }
}

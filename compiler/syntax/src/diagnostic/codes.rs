//! The codes of errors and lints, one row each.

use super::Severity;
use crate::spelling::nearest;

macro_rules! codes {
    ($($code:ident $severity:ident $title:literal;)*) => {
        /// A stable code. `E` codes are errors, `W` codes are lints.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Code { $($code),* }

        impl Code {
            pub const ALL: &'static [Self] = &[$(Self::$code),*];

            pub const fn name(self) -> &'static str {
                match self { $(Self::$code => stringify!($code)),* }
            }

            /// The diagnostic in a few words.
            pub const fn title(self) -> &'static str {
                match self { $(Self::$code => $title),* }
            }

            /// What `staunch explain` prints: what it means, a text that has it, and the text corrected.
            pub const fn page(self) -> &'static str {
                match self { $(Self::$code => include_str!(concat!("pages/", stringify!($code), ".md"))),* }
            }

            /// What it is unless the user says otherwise.
            pub const fn severity(self) -> Severity {
                match self { $(Self::$code => Severity::$severity),* }
            }

            /// A lint about which statements run and which variables they use.
            pub const fn is_of_the_flow(self) -> bool {
                matches!(self, Self::W0501 | Self::W0502 | Self::W0507)
            }

            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|it| it.name().eq_ignore_ascii_case(name))
            }

            /// The code that a misspelt one was probably meant to be: zeros are missing, or a digit is wrong.
            pub fn meant(name: &str) -> Option<Self> {
                let (letter, digits) = name.split_at_checked(1)?;
                let padded = format!("{letter}{digits:0>4}");
                Self::named(&padded).or_else(|| Self::named(nearest(name, Self::ALL.iter().map(|it| it.name()))?))
            }
        }
    };
}

// 00xx text and syntax; 01xx names; 02xx types and values; 03xx calls and blocks; 04xx
// declarations; 05xx statements; 06xx what a move between systems changes, by the number that
// `docs/compare.md` gives it; 09xx limits and what is not supported.
codes! {
    E0001 Error "a syntax error";
    E0002 Error "an unknown character";
    E0003 Error "a comment or pragma is not closed";
    E0004 Error "a string is not closed";
    E0005 Error "a number that cannot be read";
    E0006 Error "a duration or a date that cannot be read";
    E0007 Error "an unknown escape in a string";
    E0008 Error "`=` where `:=` assigns";
    E0009 Error "`:=` where `=` compares";
    E0010 Error "an operator of another language";
    E0011 Error "`ELSE IF` where `ELSIF` is meant";
    E0012 Error "a missing `;`";
    E0013 Error "a missing THEN, DO or OF";
    E0014 Error "a block is not closed";
    E0015 Error "an END_, ELSE or UNTIL without its block";
    E0016 Error "a reserved word used as a name";
    E0017 Error "a declaration after statements";
    E0018 Error "a misspelt keyword";
    E0019 Error "RETURN with a value";
    E0020 Error "a habit of another language";
    E0030 Error "too many errors";
    E0031 Error "a file that is too large";
    E0032 Error "a file of another kind";
    E0033 Error "a file of another system that cannot be read";
    E0090 Error "not supported yet";
    E0091 Error "too deep or too long";
    E0101 Error "unknown name";
    W0101 Warning "underscores in a name";
    E0102 Error "unknown type";
    W0102 Warning "a pragma without effect";
    E0103 Error "declared twice";
    W0103 Warning "a `{warning}` pragma";
    E0104 Error "reserved name";
    E0105 Error "unknown dialect";
    E0106 Error "two dialects in one file";
    E0107 Error "unknown member";
    E0108 Error "ambiguous name";
    E0109 Error "internal variable";
    E0110 Error "an `{error}` pragma";
    E0201 Error "wrong type";
    E0202 Error "value does not fit";
    E0203 Error "conversion needed";
    E0204 Error "operator does not take these types";
    E0205 Error "a constant is needed";
    E0206 Error "wrong length or count";
    E0207 Error "constant expression faults";
    E0208 Error "constant index out of range";
    E0209 Error "constant TIME overflows";
    E0210 Error "an instance is not a value";
    E0211 Error "a reference is needed, or cannot be made";
    E0212 Error "a reference that outlives what it refers to";
    E0214 Error "a lower unit of a TIME overflows";
    W0202 Warning "a string is cut off";
    E0301 Error "unknown pin or parameter";
    E0302 Error "wrong number of arguments";
    E0303 Error "argument missing";
    E0304 Error "argument given twice";
    E0305 Error "cannot be called";
    E0306 Error "a variable is needed";
    E0307 Error "unknown function";
    E0309 Error "a block of another dialect";
    E0310 Error "recursion";
    E0311 Error "the call has no value";
    E0312 Error "wrong arrow";
    E0313 Error "instruction on the wrong structure";
    E0314 Error "RCV shared by two counters";
    E0315 Error "RCV is assigned";
    E0316 Error "this cannot be mocked";
    E0317 Error "an ambiguous call of an overloaded FUNCTION";
    E0318 Error "a call without an implementation";
    E0319 Error "this cannot be `{external}`";
    E0320 Error "SUPER calls an ABSTRACT METHOD or PROPERTY";
    E0321 Error "a non-retentive assignment";
    E0402 Error "a declaration depends on itself";
    E0403 Error "not allowed in this declaration";
    E0405 Error "VAR_EXTERNAL differs from its global";
    E0406 Error "invalid array bounds";
    E0407 Error "invalid base of a subrange or enumeration";
    E0408 Error "empty type";
    E0409 Error "invalid direct address";
    E0410 Error "overlapping addresses";
    E0411 Error "misplaced generic type";
    E0412 Error "a member that cannot share its bytes";
    E0413 Error "a pool is missing or invalid";
    E0501 Error "assignment to a constant";
    E0503 Error "assignment to a FOR counter";
    E0504 Error "assignment to an output from outside";
    E0505 Error "EXIT or CONTINUE outside a loop";
    E0506 Error "duplicate CASE label";
    E0507 Error "condition is not a BOOL";
    E0508 Error "statement without effect";
    E0509 Error "FOR step is 0";
    E0510 Error "empty range of CASE labels";
    E0511 Error "assignment to an input address";
    E0512 Error "an assignment used as a value";
    E0513 Error "invalid exception handling";
    E0514 Error "a jump that is not possible";
    E0515 Error "a mistake in a sequential function chart";
    E0901 Error "too large";
    E0902 Error "not supported yet";
    E0903 Error "too many temporary variables";
    E0904 Error "a counter of S5";
    W0301 Warning "RCV is not retained";
    W0302 Warning "RETAIN does not keep this count";
    W0303 Warning "a block that starts again at each call";
    W0304 Warning "an input of a FUNCTION is left out";
    W0305 Warning "an initial count that is not used";
    W0404 Warning "a constant without a value";
    W0405 Warning "an INTERFACE is named twice";
    W0410 Warning "overlapping addresses";
    W0411 Warning "one address under two names";
    W0412 Warning "a task without a priority";
    W0413 Warning "an alias without an address";
    W0414 Warning "an address beyond its byte";
    W0415 Warning "an initial value that is not applied";
    W0501 Warning "unused variable";
    W0502 Warning "unreachable statement";
    W0503 Warning "REAL compared for equality";
    W0504 Warning "input assigned from inside";
    W0505 Warning "FOR counter assigned in its loop";
    W0507 Warning "instance called twice in a scan";
    W0508 Warning "endless loop";
    W0506 Warning "sign may change";
    W0509 Warning "assignment to an input address";
    W0510 Warning "a comparison that never changes";
    W0511 Warning "a number loses digits";
    W0512 Warning "CASE labels that overlap";
    W0513 Warning "an integer loses its high bits";
    W0514 Warning "a structure is not packed";
    W0515 Warning "a subrange wider than the array that it indexes";
    W0516 Warning "a result that is never assigned";
    W0517 Warning "a standard name is declared again";
    W0518 Warning "a variable alone as a statement";
    W0520 Warning "the size of a pointer";
    W0521 Warning "a shift that C leaves undefined";
    W0522 Warning "a stimulus that the program overwrites";
    W0523 Warning "division by the constant 0";
    W0524 Warning "a result of immediate values that does not fit a DINT";
    W0525 Warning "a lower unit of a TIME overflows";
    W0526 Warning "a body reads its own EN";
    W0527 Warning "a check that CODESYS calls implicitly";
    W0528 Warning "a diagram that other versions execute in another order";
    W0529 Warning "the system behaves differently";
    W0530 Warning "an assignment as a condition";
    W0531 Warning "a unit that ends with its file";
    W0532 Warning "a FOR loop that takes no turn";
    W0533 Warning "a CASE label that is a difference";
    W0602 Warning "a count is compared beyond its preset";
    W0608 Warning "an unsigned value is compared with a negative number";
    W0609 Warning "a pin has another name on this system";
    W0612 Warning "a counter's own output resets it";
    W0613 Warning "a preset that changes during a load";
    W0614 Warning "a FOR up to its counter's limit";
    W0616 Warning "a count down on the falling edge";
    W0617 Warning "an address that the devices' configuration gives";
    W0618 Warning "a list of global variables that loses its name";
}

//! CODESYS Standard and Standard64. Its counters are the unsigned ones of [`iec`]
//! with the pins RESET and LOAD for R and LD: an unsigned `CV <= 0` is its `CV = 0`, and an
//! unsigned minimum is its floor of 0.

use super::{iec, openplc};

/// `CTU`, counting in a WORD.
pub type Ctu = iec::Ctu<u16>;
/// `CTD`, counting in a WORD.
pub type Ctd = iec::Ctd<u16>;
/// `CTUD`, counting in a WORD.
pub type Ctud = iec::Ctud<u16>;
/// `LCTU`, counting in an LWORD.
pub type Lctu = iec::Ctu<u64>;
/// `LCTD`, counting in an LWORD.
pub type Lctd = iec::Ctd<u64>;
/// `LCTUD`, counting in an LWORD.
pub type Lctud = iec::Ctud<u64>;

/// `SR` with the pins SET1 and RESET.
pub type Sr = iec::Sr;
/// `RS` with the pins SET and RESET1.
pub type Rs = iec::Rs;

/// `CTU` according to the sentence "counts up to PV", for the option `ctu-stop-at-pv`: an edge counts
/// only while `cv < pv`.
pub type CtuStopAtPv<T> = openplc::Ctu<T>;

//! The function blocks of all systems, one row each, and the macros that read the rows.

use crate::block::{renamed, retyped};
use crate::elementary::keyword;
use crate::{
    Block, BlockInfo, BlockOption, Elementary, Facts, Family, Instruction, KeptCount, OtherPin, Pin, Prescan,
    Replacement, Retention, codesys, cscape, iec, logix, openplc, openplc4, s7,
};

/// Every standard function block, one row each.
///
/// The runtime expands the table into [`BLOCKS`]; `staunch-runtime-abi` expands it into the C
/// symbols that native code calls.
///
/// An instruction's first word says how it is called: `plain` and `timed` are function blocks
/// (a step that does not use or uses the context), `rung` takes a rung condition, `delay` a rung
/// condition and the context, `tag` nothing, `scan` the context.
/// Its method is what generated Rust calls.
#[macro_export]
macro_rules! for_each_block {
    ($expand:ident) => {
        $expand! {
            // family, name in ST, Rust type, renamed pins, [a type documented as another], #[facts], { how, name, method, symbol }
            Iec "CTU" iec::Ctu<i16> {} { plain "" call staunch_iec_ctu; }
            Iec "CTD" iec::Ctd<i16> {} { plain "" call staunch_iec_ctd; }
            Iec "CTUD" iec::Ctud<i16> {} { plain "" call staunch_iec_ctud; }
            Iec "CTU_INT" iec::Ctu<i16> {} { plain "" call staunch_iec_ctu_int; }
            Iec "CTD_INT" iec::Ctd<i16> {} { plain "" call staunch_iec_ctd_int; }
            Iec "CTUD_INT" iec::Ctud<i16> {} { plain "" call staunch_iec_ctud_int; }
            Iec "CTU_DINT" iec::Ctu<i32> {} { plain "" call staunch_iec_ctu_dint; }
            Iec "CTD_DINT" iec::Ctd<i32> {} { plain "" call staunch_iec_ctd_dint; }
            Iec "CTUD_DINT" iec::Ctud<i32> {} { plain "" call staunch_iec_ctud_dint; }
            Iec "CTU_LINT" iec::Ctu<i64> {} { plain "" call staunch_iec_ctu_lint; }
            Iec "CTD_LINT" iec::Ctd<i64> {} { plain "" call staunch_iec_ctd_lint; }
            Iec "CTUD_LINT" iec::Ctud<i64> {} { plain "" call staunch_iec_ctud_lint; }
            Iec "CTU_UDINT" iec::Ctu<u32> {} { plain "" call staunch_iec_ctu_udint; }
            Iec "CTD_UDINT" iec::Ctd<u32> {} { plain "" call staunch_iec_ctd_udint; }
            Iec "CTUD_UDINT" iec::Ctud<u32> {} { plain "" call staunch_iec_ctud_udint; }
            Iec "CTU_ULINT" iec::Ctu<u64> {} { plain "" call staunch_iec_ctu_ulint; }
            Iec "CTD_ULINT" iec::Ctd<u64> {} { plain "" call staunch_iec_ctd_ulint; }
            Iec "CTUD_ULINT" iec::Ctud<u64> {} { plain "" call staunch_iec_ctud_ulint; }

            // Shared by all dialects.
            Iec "TON" iec::Ton {} #[also "TON_TIME"] #[overload LTIME] #[in Logix "TONR with an FBD_TIMER"] { timed "" call staunch_iec_ton; }
            Iec "TOF" iec::Tof {} #[also "TOF_TIME"] #[overload LTIME] #[in Logix "TOFR with an FBD_TIMER"] { timed "" call staunch_iec_tof; }
            Iec "TP" iec::Tp {} #[also "TP_TIME"] #[overload LTIME] #[in Logix "no pulse timer: build it of a TONR"] { timed "" call staunch_iec_tp; }
            Iec "LTON" iec::Ton {} [TIME => LTIME] #[also "TON_LTIME"] #[in Logix "TONR with an FBD_TIMER"] { timed "" call staunch_iec_lton; }
            Iec "LTOF" iec::Tof {} [TIME => LTIME] #[also "TOF_LTIME"] #[in Logix "TOFR with an FBD_TIMER"] { timed "" call staunch_iec_ltof; }
            Iec "LTP" iec::Tp {} [TIME => LTIME] #[also "TP_LTIME"] #[in Logix "no pulse timer: build it of a TONR"] { timed "" call staunch_iec_ltp; }
            Iec "R_TRIG" iec::RTrig {} #[in Logix "OSRI with an FBD_ONESHOT"] { plain "" call staunch_iec_r_trig; }
            Iec "F_TRIG" iec::FTrig {} #[in Logix "OSFI with an FBD_ONESHOT"] { plain "" call staunch_iec_f_trig; }
            // What ADVANCE_TIME in a unit test is; no program names it.
            Iec "__ADVANCE_TIME" iec::AdvanceTime {} { timed "" call staunch_iec_advance_time; }
            Iec "SR" iec::Sr {} #[in Logix "SETD with a DOMINANT_SET"] { plain "" call staunch_iec_sr; }
            Iec "RS" iec::Rs {} #[in Logix "RESD with a DOMINANT_RESET"] { plain "" call staunch_iec_rs; }

            // What reads the time for TIME(); no program names it.
            Iec "__CLOCK" iec::Clock {} { timed "" call staunch_iec_clock; }

            // What notes a division by zero after which the program continues; no program names it.
            Iec "__MINOR_FAULT" iec::MinorFault {} { timed "" call staunch_iec_minor_fault; }

            // It notes the start of a cycle of a TwinCAT task; no program names it.
            Iec "__SCAN" iec::ScanInfo {} [TIME => LTIME] { timed "" call staunch_iec_scan; }

            // The compiler adds RCV to the inputs of R_CTU and R_CTD.
            // What says when a TASK with SINGLE and INTERVAL is due; no program names it.
            Iec "__TASK" iec::TaskTurn {} { timed "" call staunch_iec_task; }

            Cscape "CTU" cscape::Ctu {} #[counts_levels] #[stops] { plain "" call staunch_cscape_ctu; }
            Cscape "CTD" cscape::Ctd {} #[counts_levels] #[stops] { plain "" call staunch_cscape_ctd; }
            Cscape "R_CTU" cscape::RCtu {} #[kept "CTU" in "RCV"] #[counts_levels] #[stops] { plain "" call staunch_cscape_r_ctu; }
            Cscape "R_CTD" cscape::RCtd {} #[kept "CTD" in "RCV"] #[counts_levels] #[stops] { plain "" call staunch_cscape_r_ctd; }

            Codesys "CTU" codesys::Ctu { "R" => "RESET" } [UINT => WORD] { plain "" call staunch_codesys_ctu; }
            Codesys "CTD" codesys::Ctd { "LD" => "LOAD" } [UINT => WORD] { plain "" call staunch_codesys_ctd; }
            Codesys "CTUD" codesys::Ctud { "R" => "RESET", "LD" => "LOAD" } [UINT => WORD] { plain "" call staunch_codesys_ctud; }
            Codesys "LCTU" codesys::Lctu { "R" => "RESET" } [ULINT => LWORD] { plain "" call staunch_codesys_lctu; }
            Codesys "LCTD" codesys::Lctd { "LD" => "LOAD" } [ULINT => LWORD] { plain "" call staunch_codesys_lctd; }
            Codesys "LCTUD" codesys::Lctud { "R" => "RESET", "LD" => "LOAD" } [ULINT => LWORD] { plain "" call staunch_codesys_lctud; }
            Codesys "SR" codesys::Sr { "S1" => "SET1", "R" => "RESET" } #[in Logix "SETD with a DOMINANT_SET"] { plain "" call staunch_codesys_sr; }
            Codesys "RS" codesys::Rs { "S" => "SET", "R1" => "RESET1" } #[in Logix "RESD with a DOMINANT_RESET"] { plain "" call staunch_codesys_rs; }
            // What CTU and LCTU mean under the option `ctu-stop-at-pv`.
            Codesys "CTU_STOP_AT_PV" codesys::CtuStopAtPv<u16> { "R" => "RESET" } [UINT => WORD] #[option CtuStopAtPv for "CTU"] #[stops] { plain "" call staunch_codesys_ctu_stop_at_pv; }
            Codesys "LCTU_STOP_AT_PV" codesys::CtuStopAtPv<u64> { "R" => "RESET" } [ULINT => LWORD] #[option CtuStopAtPv for "LCTU"] #[stops] { plain "" call staunch_codesys_lctu_stop_at_pv; }

            Openplc "CTU" openplc::Ctu<i16> {} #[stops] { plain "" call staunch_openplc_ctu; }
            Openplc "CTD" openplc::Ctd<i16> {} #[stops] { plain "" call staunch_openplc_ctd; }
            Openplc "CTUD" openplc::Ctud<i16> {} #[stops] { plain "" call staunch_openplc_ctud; }
            Openplc "CTU_INT" openplc::Ctu<i16> {} #[stops] { plain "" call staunch_openplc_ctu_int; }
            Openplc "CTD_INT" openplc::Ctd<i16> {} #[stops] { plain "" call staunch_openplc_ctd_int; }
            Openplc "CTUD_INT" openplc::Ctud<i16> {} #[stops] { plain "" call staunch_openplc_ctud_int; }
            Openplc "CTU_DINT" openplc::Ctu<i32> {} #[stops] { plain "" call staunch_openplc_ctu_dint; }
            Openplc "CTD_DINT" openplc::Ctd<i32> {} #[stops] { plain "" call staunch_openplc_ctd_dint; }
            Openplc "CTUD_DINT" openplc::Ctud<i32> {} #[stops] { plain "" call staunch_openplc_ctud_dint; }
            Openplc "CTU_LINT" openplc::Ctu<i64> {} #[stops] { plain "" call staunch_openplc_ctu_lint; }
            Openplc "CTD_LINT" openplc::Ctd<i64> {} #[stops] { plain "" call staunch_openplc_ctd_lint; }
            Openplc "CTUD_LINT" openplc::Ctud<i64> {} #[stops] { plain "" call staunch_openplc_ctud_lint; }
            Openplc "CTU_UDINT" openplc::Ctu<u32> {} #[stops] { plain "" call staunch_openplc_ctu_udint; }
            Openplc "CTD_UDINT" openplc::Ctd<u32> {} #[stops] { plain "" call staunch_openplc_ctd_udint; }
            Openplc "CTUD_UDINT" openplc::Ctud<u32> {} #[stops] { plain "" call staunch_openplc_ctud_udint; }
            Openplc "CTU_ULINT" openplc::Ctu<u64> {} #[stops] { plain "" call staunch_openplc_ctu_ulint; }
            Openplc "CTD_ULINT" openplc::Ctd<u64> {} #[stops] { plain "" call staunch_openplc_ctd_ulint; }
            Openplc "CTUD_ULINT" openplc::Ctud<u64> {} #[stops] { plain "" call staunch_openplc_ctud_ulint; }
            Openplc "TON" openplc::Ton {} #[also "TON_TIME"] #[overload LTIME] #[in Logix "TONR with an FBD_TIMER"] { timed "" call staunch_openplc_ton; }
            Openplc "TOF" openplc::Tof {} #[also "TOF_TIME"] #[overload LTIME] #[in Logix "TOFR with an FBD_TIMER"] { timed "" call staunch_openplc_tof; }
            Openplc "TP" openplc::Tp {} #[also "TP_TIME"] #[overload LTIME] #[in Logix "no pulse timer: build it of a TONR"] { timed "" call staunch_openplc_tp; }
            Openplc "F_TRIG" iec::FTrig {} #[in Logix "OSFI with an FBD_ONESHOT"] { plain "" call staunch_openplc_f_trig; }
            // What F_TRIG means under the setting `openplc-f-trig = "before-2024-12"`.
            Openplc "F_TRIG_BEFORE_2024_12" openplc::FTrig {} #[option FTrigBefore202412 for "F_TRIG"] #[in Logix "OSFI with an FBD_ONESHOT"] { plain "" call staunch_openplc_f_trig_before_2024_12; }

            Openplc4 "CTU" openplc4::Ctu<i16> {} #[stops] { plain "" call staunch_openplc4_ctu; }
            Openplc4 "CTD" openplc4::Ctd<i16> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctd; }
            Openplc4 "CTUD" openplc4::Ctud<i16> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctud; }
            Openplc4 "CTU_INT" openplc4::Ctu<i16> {} #[stops] { plain "" call staunch_openplc4_ctu_int; }
            Openplc4 "CTD_INT" openplc4::Ctd<i16> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctd_int; }
            Openplc4 "CTUD_INT" openplc4::Ctud<i16> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctud_int; }
            Openplc4 "CTU_DINT" openplc4::Ctu<i32> {} #[stops] { plain "" call staunch_openplc4_ctu_dint; }
            Openplc4 "CTD_DINT" openplc4::Ctd<i32> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctd_dint; }
            Openplc4 "CTUD_DINT" openplc4::Ctud<i32> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctud_dint; }
            Openplc4 "CTU_LINT" openplc4::Ctu<i64> {} #[stops] { plain "" call staunch_openplc4_ctu_lint; }
            Openplc4 "CTD_LINT" openplc4::Ctd<i64> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctd_lint; }
            Openplc4 "CTUD_LINT" openplc4::Ctud<i64> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctud_lint; }
            Openplc4 "CTU_UDINT" openplc4::Ctu<u32> {} #[stops] { plain "" call staunch_openplc4_ctu_udint; }
            Openplc4 "CTD_UDINT" openplc4::Ctd<u32> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctd_udint; }
            Openplc4 "CTUD_UDINT" openplc4::Ctud<u32> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctud_udint; }
            Openplc4 "CTU_ULINT" openplc4::Ctu<u64> {} #[stops] { plain "" call staunch_openplc4_ctu_ulint; }
            Openplc4 "CTD_ULINT" openplc4::Ctd<u64> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctd_ulint; }
            Openplc4 "CTUD_ULINT" openplc4::Ctud<u64> {} #[stops] #[counts_falls] { plain "" call staunch_openplc4_ctud_ulint; }
            // What CTD and CTUD mean under the option `openplc4-cd-edge = "rising"`.
            Openplc4 "CTD_RISING" openplc4::CtdRising<i16> {} #[option CdRises for "CTD"] #[stops] { plain "" call staunch_openplc4_ctd_rising; }
            Openplc4 "CTUD_RISING" openplc4::CtudRising<i16> {} #[option CdRises for "CTUD"] #[stops] { plain "" call staunch_openplc4_ctud_rising; }
            Openplc4 "CTD_INT_RISING" openplc4::CtdRising<i16> {} #[option CdRises for "CTD_INT"] #[stops] { plain "" call staunch_openplc4_ctd_int_rising; }
            Openplc4 "CTUD_INT_RISING" openplc4::CtudRising<i16> {} #[option CdRises for "CTUD_INT"] #[stops] { plain "" call staunch_openplc4_ctud_int_rising; }
            Openplc4 "CTD_DINT_RISING" openplc4::CtdRising<i32> {} #[option CdRises for "CTD_DINT"] #[stops] { plain "" call staunch_openplc4_ctd_dint_rising; }
            Openplc4 "CTUD_DINT_RISING" openplc4::CtudRising<i32> {} #[option CdRises for "CTUD_DINT"] #[stops] { plain "" call staunch_openplc4_ctud_dint_rising; }
            Openplc4 "CTD_LINT_RISING" openplc4::CtdRising<i64> {} #[option CdRises for "CTD_LINT"] #[stops] { plain "" call staunch_openplc4_ctd_lint_rising; }
            Openplc4 "CTUD_LINT_RISING" openplc4::CtudRising<i64> {} #[option CdRises for "CTUD_LINT"] #[stops] { plain "" call staunch_openplc4_ctud_lint_rising; }
            Openplc4 "CTD_UDINT_RISING" openplc4::CtdRising<u32> {} #[option CdRises for "CTD_UDINT"] #[stops] { plain "" call staunch_openplc4_ctd_udint_rising; }
            Openplc4 "CTUD_UDINT_RISING" openplc4::CtudRising<u32> {} #[option CdRises for "CTUD_UDINT"] #[stops] { plain "" call staunch_openplc4_ctud_udint_rising; }
            Openplc4 "CTD_ULINT_RISING" openplc4::CtdRising<u64> {} #[option CdRises for "CTD_ULINT"] #[stops] { plain "" call staunch_openplc4_ctd_ulint_rising; }
            Openplc4 "CTUD_ULINT_RISING" openplc4::CtudRising<u64> {} #[option CdRises for "CTUD_ULINT"] #[stops] { plain "" call staunch_openplc4_ctud_ulint_rising; }
            Openplc4 "TON" openplc4::Ton {} #[also "TON_TIME"] #[overload LTIME] #[in Logix "TONR with an FBD_TIMER"] { timed "" call staunch_openplc4_ton; }
            Openplc4 "TOF" openplc4::Tof {} #[also "TOF_TIME"] #[overload LTIME] #[in Logix "TOFR with an FBD_TIMER"] { timed "" call staunch_openplc4_tof; }
            Openplc4 "TP" openplc4::Tp {} #[also "TP_TIME"] #[overload LTIME] #[in Logix "no pulse timer: build it of a TONR"] { timed "" call staunch_openplc4_tp; }

            // An S7-1200 counts in all but LINT and ULINT. A bare name counts in INT, as SFB 0, 1 and 2 do; those call LD LOAD.
            S7 "CTU" s7::Ctu<i16> {} #[also "CTU_INT"] #[pin "QU" is "Q"] { plain "" call staunch_s7_ctu; }
            S7 "CTD" s7::Ctd<i16> {} #[also "CTD_INT"] #[pin "LOAD" is "LD", "QD" is "Q"] { plain "" call staunch_s7_ctd; }
            S7 "CTUD" s7::Ctud<i16> {} #[also "CTUD_INT"] #[pin "LOAD" is "LD"] { plain "" call staunch_s7_ctud; }
            S7 "CTU_SINT" s7::Ctu<i8> {} #[pin "QU" is "Q"] { plain "" call staunch_s7_ctu_sint; }
            S7 "CTD_SINT" s7::Ctd<i8> {} #[pin "LOAD" is "LD", "QD" is "Q"] { plain "" call staunch_s7_ctd_sint; }
            S7 "CTUD_SINT" s7::Ctud<i8> {} #[pin "LOAD" is "LD"] { plain "" call staunch_s7_ctud_sint; }
            S7 "CTU_DINT" s7::Ctu<i32> {} #[pin "QU" is "Q"] { plain "" call staunch_s7_ctu_dint; }
            S7 "CTD_DINT" s7::Ctd<i32> {} #[pin "LOAD" is "LD", "QD" is "Q"] { plain "" call staunch_s7_ctd_dint; }
            S7 "CTUD_DINT" s7::Ctud<i32> {} #[pin "LOAD" is "LD"] { plain "" call staunch_s7_ctud_dint; }
            S7 "CTU_LINT" s7::Ctu<i64> {} #[pin "QU" is "Q"] { plain "" call staunch_s7_ctu_lint; }
            S7 "CTD_LINT" s7::Ctd<i64> {} #[pin "LOAD" is "LD", "QD" is "Q"] { plain "" call staunch_s7_ctd_lint; }
            S7 "CTUD_LINT" s7::Ctud<i64> {} #[pin "LOAD" is "LD"] { plain "" call staunch_s7_ctud_lint; }
            S7 "CTU_USINT" s7::Ctu<u8> {} #[pin "QU" is "Q"] { plain "" call staunch_s7_ctu_usint; }
            S7 "CTD_USINT" s7::Ctd<u8> {} #[pin "LOAD" is "LD", "QD" is "Q"] { plain "" call staunch_s7_ctd_usint; }
            S7 "CTUD_USINT" s7::Ctud<u8> {} #[pin "LOAD" is "LD"] { plain "" call staunch_s7_ctud_usint; }
            S7 "CTU_UINT" s7::Ctu<u16> {} #[pin "QU" is "Q"] { plain "" call staunch_s7_ctu_uint; }
            S7 "CTD_UINT" s7::Ctd<u16> {} #[pin "LOAD" is "LD", "QD" is "Q"] { plain "" call staunch_s7_ctd_uint; }
            S7 "CTUD_UINT" s7::Ctud<u16> {} #[pin "LOAD" is "LD"] { plain "" call staunch_s7_ctud_uint; }
            S7 "CTU_UDINT" s7::Ctu<u32> {} #[pin "QU" is "Q"] { plain "" call staunch_s7_ctu_udint; }
            S7 "CTD_UDINT" s7::Ctd<u32> {} #[pin "LOAD" is "LD", "QD" is "Q"] { plain "" call staunch_s7_ctd_udint; }
            S7 "CTUD_UDINT" s7::Ctud<u32> {} #[pin "LOAD" is "LD"] { plain "" call staunch_s7_ctud_udint; }
            S7 "CTU_ULINT" s7::Ctu<u64> {} #[pin "QU" is "Q"] { plain "" call staunch_s7_ctu_ulint; }
            S7 "CTD_ULINT" s7::Ctd<u64> {} #[pin "LOAD" is "LD", "QD" is "Q"] { plain "" call staunch_s7_ctd_ulint; }
            S7 "CTUD_ULINT" s7::Ctud<u64> {} #[pin "LOAD" is "LD"] { plain "" call staunch_s7_ctud_ulint; }
            // What CTD and CTUD mean under the option `s7-ld = "edge"`.
            S7 "CTD_LD_EDGE" s7::CtdLdEdge<i16> {} #[option LdEdge for "CTD"] #[pin "LOAD" is "LD", "QD" is "Q"] #[loads_on_edges] { plain "" call staunch_s7_ctd_ld_edge; }
            S7 "CTUD_LD_EDGE" s7::CtudLdEdge<i16> {} #[option LdEdge for "CTUD"] #[pin "LOAD" is "LD"] #[loads_on_edges] { plain "" call staunch_s7_ctud_ld_edge; }
            S7 "CTD_SINT_LD_EDGE" s7::CtdLdEdge<i8> {} #[option LdEdge for "CTD_SINT"] #[pin "LOAD" is "LD", "QD" is "Q"] #[loads_on_edges] { plain "" call staunch_s7_ctd_sint_ld_edge; }
            S7 "CTUD_SINT_LD_EDGE" s7::CtudLdEdge<i8> {} #[option LdEdge for "CTUD_SINT"] #[pin "LOAD" is "LD"] #[loads_on_edges] { plain "" call staunch_s7_ctud_sint_ld_edge; }
            S7 "CTD_DINT_LD_EDGE" s7::CtdLdEdge<i32> {} #[option LdEdge for "CTD_DINT"] #[pin "LOAD" is "LD", "QD" is "Q"] #[loads_on_edges] { plain "" call staunch_s7_ctd_dint_ld_edge; }
            S7 "CTUD_DINT_LD_EDGE" s7::CtudLdEdge<i32> {} #[option LdEdge for "CTUD_DINT"] #[pin "LOAD" is "LD"] #[loads_on_edges] { plain "" call staunch_s7_ctud_dint_ld_edge; }
            S7 "CTD_LINT_LD_EDGE" s7::CtdLdEdge<i64> {} #[option LdEdge for "CTD_LINT"] #[pin "LOAD" is "LD", "QD" is "Q"] #[loads_on_edges] { plain "" call staunch_s7_ctd_lint_ld_edge; }
            S7 "CTUD_LINT_LD_EDGE" s7::CtudLdEdge<i64> {} #[option LdEdge for "CTUD_LINT"] #[pin "LOAD" is "LD"] #[loads_on_edges] { plain "" call staunch_s7_ctud_lint_ld_edge; }
            S7 "CTD_USINT_LD_EDGE" s7::CtdLdEdge<u8> {} #[option LdEdge for "CTD_USINT"] #[pin "LOAD" is "LD", "QD" is "Q"] #[loads_on_edges] { plain "" call staunch_s7_ctd_usint_ld_edge; }
            S7 "CTUD_USINT_LD_EDGE" s7::CtudLdEdge<u8> {} #[option LdEdge for "CTUD_USINT"] #[pin "LOAD" is "LD"] #[loads_on_edges] { plain "" call staunch_s7_ctud_usint_ld_edge; }
            S7 "CTD_UINT_LD_EDGE" s7::CtdLdEdge<u16> {} #[option LdEdge for "CTD_UINT"] #[pin "LOAD" is "LD", "QD" is "Q"] #[loads_on_edges] { plain "" call staunch_s7_ctd_uint_ld_edge; }
            S7 "CTUD_UINT_LD_EDGE" s7::CtudLdEdge<u16> {} #[option LdEdge for "CTUD_UINT"] #[pin "LOAD" is "LD"] #[loads_on_edges] { plain "" call staunch_s7_ctud_uint_ld_edge; }
            S7 "CTD_UDINT_LD_EDGE" s7::CtdLdEdge<u32> {} #[option LdEdge for "CTD_UDINT"] #[pin "LOAD" is "LD", "QD" is "Q"] #[loads_on_edges] { plain "" call staunch_s7_ctd_udint_ld_edge; }
            S7 "CTUD_UDINT_LD_EDGE" s7::CtudLdEdge<u32> {} #[option LdEdge for "CTUD_UDINT"] #[pin "LOAD" is "LD"] #[loads_on_edges] { plain "" call staunch_s7_ctud_udint_ld_edge; }
            S7 "CTD_ULINT_LD_EDGE" s7::CtdLdEdge<u64> {} #[option LdEdge for "CTD_ULINT"] #[pin "LOAD" is "LD", "QD" is "Q"] #[loads_on_edges] { plain "" call staunch_s7_ctd_ulint_ld_edge; }
            S7 "CTUD_ULINT_LD_EDGE" s7::CtudLdEdge<u64> {} #[option LdEdge for "CTUD_ULINT"] #[pin "LOAD" is "LD"] #[loads_on_edges] { plain "" call staunch_s7_ctud_ulint_ld_edge; }

            S7 "TONR" s7::Tonr {} #[also "TONR_TIME"] #[in Logix "RTOR with an FBD_TIMER"] { timed "" call staunch_s7_tonr; }

            Logix "COUNTER" logix::Counter {} {
                rung "CTU" ctu staunch_logix_counter_ctu, prescan prescan_ctu staunch_logix_counter_prescan_ctu;
                rung "CTD" ctd staunch_logix_counter_ctd, prescan prescan_ctd staunch_logix_counter_prescan_ctd;
                rung "RES" res staunch_logix_counter_res;
            }
            Logix "FBD_COUNTER" logix::FbdCounter {} {
                tag "CTUD" ctud staunch_logix_fbd_counter_ctud, prescan prescan_ctud staunch_logix_fbd_counter_prescan_ctud;
            }
            Logix "TIMER" logix::Timer {} {
                delay "TON" ton staunch_logix_timer_ton, prescan prescan_ton staunch_logix_timer_prescan_ton;
                delay "TOF" tof staunch_logix_timer_tof, prescan prescan_tof staunch_logix_timer_prescan_tof;
                delay "RTO" rto staunch_logix_timer_rto, prescan prescan_rto staunch_logix_timer_prescan_rto;
                rung "RES" res staunch_logix_timer_res;
            }
            Logix "FBD_TIMER" logix::FbdTimer {} {
                scan "TONR" tonr staunch_logix_fbd_timer_tonr;
                scan "TOFR" tofr staunch_logix_fbd_timer_tofr;
                scan "RTOR" rtor staunch_logix_fbd_timer_rtor;
            }
            Logix "FBD_ONESHOT" logix::FbdOneshot {} {
                scan "OSRI" osri staunch_logix_fbd_oneshot_osri;
                scan "OSFI" osfi staunch_logix_fbd_oneshot_osfi;
            }
        }
    };
}

/// Runs an instruction of [`for_each_block!`] on a Rust struct.
#[doc(hidden)]
#[macro_export]
macro_rules! run_instruction {
    (plain $block:ident $method:ident $cx:expr, $rung:expr) => {
        $block.step($cx)
    };
    (timed $block:ident $method:ident $cx:expr, $rung:expr) => {
        $block.step($cx)
    };
    (rung $block:ident $method:ident $cx:expr, $rung:expr) => {{
        $block.$method($rung);
    }};
    (delay $block:ident $method:ident $cx:expr, $rung:expr) => {{
        $block.$method($rung, $cx);
    }};
    (tag $block:ident $method:ident $cx:expr, $rung:expr) => {
        $block.$method()
    };
    (scan $block:ident $method:ident $cx:expr, $rung:expr) => {
        $block.$method($cx)
    };
}

macro_rules! declare_blocks {
    ($($family:ident $name:literal $block:ty { $($pin:literal => $renamed:literal),* } $([$ty:ident => $retyped:ident])? $(#[$($fact:tt)*])* {
        $($how:ident $instruction:literal $method:ident $symbol:ident
            $(, prescan $prescan:ident $prescan_symbol:ident)?;)*
    })*) => {
        /// Every standard function block. A block's position is its number in the compiler.
        pub static BLOCKS: &[BlockInfo] = &[$(BlockInfo {
            family: Family::$family,
            name: $name,
            rust_path: stringify!($block),
            size: size_of::<$block>(),
            align: align_of::<$block>(),
            pins: {
                const PINS: &[Pin] = <$block as Block>::PINS;
                const RENAMED: &[Pin] = &renamed::<{ PINS.len() }>(PINS, &[$(($pin, $renamed)),*]);
                const TYPES: &[(Elementary, Elementary)] = &[$((keyword::$ty, keyword::$retyped))?];
                const RETYPED: &[Pin] = &retyped::<{ PINS.len() }>(RENAMED, TYPES);
                RETYPED
            },
            instructions: &[$(Instruction {
                name: $instruction,
                method: stringify!($method),
                symbol: stringify!($symbol),
                takes_rung: is!($how rung) || is!($how delay),
                needs_context: is!($how timed) || is!($how scan) || is!($how delay),
                run: |bytes, _cx, _rung| {
                    let mut block = <$block as Block>::load(bytes);
                    $crate::run_instruction!($how block $method _cx, _rung);
                    block.store(bytes);
                },
                prescan: prescan!($block $(, $prescan $prescan_symbol)?),
            }),*],
            retention: retention!($family),
            facts: {
                let facts = Facts::NONE;
                $(let facts = fact!(facts, $($fact)*);)*
                facts
            },
        }),*];
    };
}

macro_rules! is {
    (rung rung) => {
        true
    };
    (timed timed) => {
        true
    };
    (delay delay) => {
        true
    };
    (scan scan) => {
        true
    };
    ($how:ident $other:ident) => {
        false
    };
}

macro_rules! prescan {
    ($block:ty) => {
        None
    };
    ($block:ty, $prescan:ident $symbol:ident) => {
        Some(Prescan {
            method: stringify!($prescan),
            symbol: stringify!($symbol),
            run: |bytes| {
                let mut block = <$block as Block>::load(bytes);
                block.$prescan();
                block.store(bytes);
            },
        })
    };
}

/// `facts` with one more fact.
macro_rules! fact {
    ($facts:ident, also $name:literal) => {
        Facts { alias: Some($name), ..$facts }
    };
    ($facts:ident, overload $ty:ident) => {
        Facts { overload: Some(keyword::$ty), ..$facts }
    };
    ($facts:ident, option $option:ident for $of:literal) => {
        Facts { option: Some(Replacement { option: BlockOption::$option, of: $of }), ..$facts }
    };
    ($facts:ident, kept $plain:literal in $pin:literal) => {
        Facts { kept: Some(KeptCount { pin: $pin, plain: $plain }), ..$facts }
    };
    ($facts:ident, counts_levels) => {
        Facts { counts_levels: true, ..$facts }
    };
    ($facts:ident, counts_falls) => {
        Facts { counts_falls: true, ..$facts }
    };
    ($facts:ident, in $family:ident $instead:literal) => {
        Facts { instead: Some((Family::$family, $instead)), ..$facts }
    };
    ($facts:ident, loads_on_edges) => {
        Facts { loads_on_edges: true, ..$facts }
    };
    ($facts:ident, pin $($other:literal is $pin:literal),+) => {
        Facts { other_pins: &[$(OtherPin { name: $other, pin: $pin }),+], ..$facts }
    };
    ($facts:ident, stops) => {
        Facts { stops: true, ..$facts }
    };
}

/// Logix keeps every tag over a restart, Cscape only the counts that R_CTU and R_CTD have in RCV;
/// elsewhere the declaration decides.
macro_rules! retention {
    (Logix) => {
        Retention::Always
    };
    (Cscape) => {
        Retention::Inputs
    };
    ($family:ident) => {
        Retention::Declared
    };
}

for_each_block!(declare_blocks);

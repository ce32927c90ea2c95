//! The machines that code is made for, and Cranelift's settings for each.

use crate::Error;
use cranelift_codegen::isa::{self, OwnedTargetIsa, TargetIsa};
use cranelift_codegen::settings::{self, Configurable, Flags, OptLevel};
use std::str::FromStr;
use target_lexicon::{Aarch64Architecture, Architecture, BinaryFormat, Environment, PointerWidth, Triple};

/// A machine and system that [`object`](crate::object) makes code for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    triple: Triple,
    machine: Machine,
    aim: Aim,
}

/// What code is made for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Aim {
    /// As few instructions in a scan as can be.
    #[default]
    Speed,
    /// As few bytes of code: blocks and routines are called, and loops stay loops.
    Size,
    /// A debugger, which finds each statement at one place and each variable in memory. An object has debug information.
    Debugging,
}

impl Aim {
    pub(crate) fn of(isa: &dyn TargetIsa) -> Self {
        match isa.flags().opt_level() {
            OptLevel::SpeedAndSize => Self::Size,
            OptLevel::None => Self::Debugging,
            OptLevel::Speed => Self::Speed,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Machine {
    X86_64,
    Aarch64,
    Riscv64,
}

/// Instructions that every x86-64-v2 machine has. Without them rounding becomes calls of libm.
const X86_64: &[&str] = &["has_sse3", "has_ssse3", "has_sse41", "has_sse42", "has_popcnt"];
/// The G in riscv64gc.
const RISCV64: &[&str] = &["has_m", "has_a", "has_f", "has_d", "has_zicsr", "has_zifencei"];

impl Target {
    /// The targets that the tests link and run. Others of these machines with ELF objects, such
    /// as musl, work the same way.
    pub const SUPPORTED: [&'static str; 4] = [
        "x86_64-unknown-linux-gnu",
        "aarch64-unknown-linux-gnu",
        "riscv64gc-unknown-linux-gnu",
        "x86_64-pc-windows-gnu",
    ];

    /// The machine that this runs on.
    ///
    /// # Errors
    /// If it is none that native code is made for.
    pub fn host() -> Result<Self, Error> {
        Self::of_triple(Triple::host())
    }

    /// A target by its Rust triple, or by `x86_64`, `aarch64` or `riscv64` for Linux.
    ///
    /// # Errors
    /// If native code is not supported for it; the text says what a user can do.
    pub fn parse(name: &str) -> Result<Self, Error> {
        let name = match name {
            "x86_64" => Self::SUPPORTED[0],
            "aarch64" => Self::SUPPORTED[1],
            "riscv64" | "riscv64gc" => Self::SUPPORTED[2],
            other => other,
        };
        Self::of_triple(Triple::from_str(name).map_err(|_| unknown(name))?)
    }

    fn of_triple(triple: Triple) -> Result<Self, Error> {
        let name = triple.to_string();
        if matches!(triple.pointer_width(), Ok(PointerWidth::U16 | PointerWidth::U32)) {
            return Err(narrow(&name));
        }
        let machine = match triple.architecture {
            Architecture::X86_64 => Machine::X86_64,
            Architecture::Aarch64(Aarch64Architecture::Aarch64) => Machine::Aarch64,
            Architecture::Riscv64(_) => Machine::Riscv64,
            _ => return Err(unknown(&name)),
        };
        let is_known = match triple.binary_format {
            BinaryFormat::Elf => triple.environment != Environment::Sgx,
            BinaryFormat::Coff => machine == Machine::X86_64 && triple.environment == Environment::Gnu,
            _ => false,
        };
        if is_known { Ok(Self { triple, machine, aim: Aim::Speed }) } else { Err(unknown(&name)) }
    }

    /// The same machine, with code for that aim.
    #[must_use]
    pub fn aiming_at(self, aim: Aim) -> Self {
        Self { aim, ..self }
    }

    /// The triple.
    pub fn name(&self) -> String {
        self.triple.to_string()
    }

    /// Whether instructions of its code are counted.
    pub fn has_counts(&self) -> bool {
        self.machine == Machine::X86_64
    }

    pub(crate) fn is_for_debugging(&self) -> bool {
        self.aim == Aim::Debugging
    }

    pub(crate) fn architecture(&self) -> Architecture {
        self.triple.architecture
    }

    pub(crate) fn is_elf(&self) -> bool {
        self.triple.binary_format == BinaryFormat::Elf
    }

    /// For objects that any machine of the target runs.
    pub(crate) fn isa(&self) -> Result<OwnedTargetIsa, Error> {
        let mut builder = isa::lookup(self.triple.clone()).map_err(|_| unknown(&self.name()))?;
        let features = match self.machine {
            Machine::X86_64 => X86_64,
            Machine::Aarch64 => &[],
            Machine::Riscv64 => RISCV64,
        };
        for feature in features {
            builder.enable(feature).expect("a feature of the machine");
        }
        // Windows moves code by relocations, and has no table of addresses that position-independent code would ask.
        let is_pic = if self.is_elf() { "true" } else { "false" };
        builder.finish(flags(is_pic, self.aim)).map_err(|error| Error::Output(error.to_string()))
    }
}

/// For code that runs here and now, with all that this machine can do.
pub(crate) fn native_isa(aim: Aim) -> Result<OwnedTargetIsa, Error> {
    let builder = cranelift_native::builder().map_err(|error| Error::Target(error.to_owned()))?;
    builder.finish(flags("false", aim)).map_err(|error| Error::Output(error.to_string()))
}

/// The same machine and settings, but without optimisation.
pub(crate) fn plain_isa(isa: &dyn TargetIsa) -> OwnedTargetIsa {
    let known = "the settings are those of a target that is in use";
    let mut builder = isa::lookup(isa.triple().clone()).expect(known);
    for value in isa.isa_flags() {
        builder.set(value.name, &value.value_string()).expect(known);
    }
    let mut flags = settings::builder();
    for value in isa.flags().iter() {
        flags.set(value.name, &value.value_string()).expect(known);
    }
    flags.set("opt_level", "none").expect(known);
    builder.finish(Flags::new(flags)).expect(known)
}

fn flags(is_pic: &str, aim: Aim) -> Flags {
    let level = match aim {
        Aim::Speed => "speed",
        Aim::Size => "speed_and_size",
        Aim::Debugging => "none",
    };
    let is_debugged = if aim == Aim::Debugging { "true" } else { "false" };
    let verifier = if cfg!(debug_assertions) { "true" } else { "false" };
    let mut flags = settings::builder();
    for (name, value) in [
        ("is_pic", is_pic),
        ("opt_level", level),
        ("enable_verifier", verifier),
        // An .eh_frame from Cranelift needs absolute relocations, which static PIE refuses; a debugger reads a section that is not
        // loaded.
        ("unwind_info", is_debugged),
        ("preserve_frame_pointers", is_debugged),
        // A frame larger than the guard page touches each page.
        ("enable_probestack", "true"),
        ("probestack_strategy", "inline"),
        // Where blocks begin, for counting instructions.
        ("machine_code_cfg_info", "true"),
    ] {
        flags.set(name, value).expect("a setting of Cranelift");
    }
    Flags::new(flags)
}

fn narrow(name: &str) -> Error {
    Error::Target(format!(
        "the native back end makes 64-bit code only; for {name} use --backend rust (or --emit rust) \
         and compile the result with rustc"
    ))
}

fn unknown(name: &str) -> Error {
    let supported = Target::SUPPORTED.join(", ");
    Error::Target(format!(
        "the native back end does not know the target {name}; it makes code for {supported} \
         (for any other target use --backend rust)"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_names_are_linux() {
        let names = ["x86_64", "aarch64", "riscv64"].map(|name| Target::parse(name).unwrap().name());
        assert_eq!(names, Target::SUPPORTED[..3]);
        for name in Target::SUPPORTED {
            let isa = Target::parse(name).unwrap().isa().unwrap();
            assert_eq!(plain_isa(&*isa).flags().opt_level(), OptLevel::None);
        }
        assert!(Target::parse("x86_64-unknown-linux-musl").unwrap().isa().is_ok());
        assert!(Target::host().is_ok());
    }

    #[test]
    fn narrow_targets_are_sent_to_rust() {
        for name in [
            "armv7-unknown-linux-gnueabihf",
            "thumbv7em-none-eabihf",
            "riscv32imac-unknown-none-elf",
            "i686-unknown-linux-gnu",
        ] {
            let text = Target::parse(name).unwrap_err().to_string();
            assert!(text.contains("--backend rust (or --emit rust)"), "{text}");
            assert!(text.contains(name), "{text}");
        }
    }

    #[test]
    fn unknown_targets_name_the_known_ones() {
        for name in ["vax", "x86_64-pc-windows-msvc", "s390x-unknown-linux-gnu", "aarch64_be-unknown-linux-gnu"] {
            let text = Target::parse(name).unwrap_err().to_string();
            assert!(Target::SUPPORTED.iter().all(|known| text.contains(known)), "{text}");
        }
    }
}

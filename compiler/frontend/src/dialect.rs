//! Whose blocks a bare name means, and what a dialect allows beyond the standard.

pub(crate) mod library;
pub(crate) mod missing;
pub mod rules;

use crate::spelling::{Key, nearest};
use rustc_hash::FxHashMap;
use staunch_ir::BlockId;
use staunch_runtime::{BLOCKS, BlockInfo, BlockOption, Family};
use std::sync::LazyLock;

/// The system whose habits a source file follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Dialect {
    /// IEC 61131-3 third edition, with the counters of Autonomy Edge.
    #[default]
    Iec,
    /// Horner Cscape, IEC editor.
    Cscape,
    /// CODESYS (and TwinCAT).
    Codesys,
    /// OpenPLC v3, OpenPLC Editor before v4.2, and Beremiz: as `Iec`, with MATIEC's counters.
    Openplc,
    /// OpenPLC from v4.1: as `Iec`, with the counters and timers of STruC++.
    Openplc4,
    /// Rockwell Logix 5000.
    Logix,
    /// SCL of Siemens' S7: as `Iec`, with the IEC counters of S7.
    Siemens,
}

impl Dialect {
    pub const ALL: [Self; 7] =
        [Self::Iec, Self::Cscape, Self::Codesys, Self::Openplc, Self::Openplc4, Self::Logix, Self::Siemens];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Iec => "iec",
            Self::Cscape => "cscape",
            Self::Codesys => "codesys",
            Self::Openplc => "openplc",
            Self::Openplc4 => "openplc4",
            Self::Logix => "logix",
            Self::Siemens => "siemens",
        }
    }

    /// What to write for what this dialect alone has.
    pub(crate) fn how_to_choose(self) -> String {
        let name = self.name();
        format!("start the file with `{{dialect '{name}'}}`, or compile with `--dialect {name}`")
    }

    /// All names that are understood, those that dialects have besides their own among them.
    pub fn names() -> impl Iterator<Item = (&'static str, Self)> {
        Self::ALL
            .into_iter()
            .flat_map(|it| [Some(it.name()), it.alias()].into_iter().flatten().map(move |name| (name, it)))
    }

    /// What it is called besides.
    const fn alias(self) -> Option<&'static str> {
        match self {
            Self::Codesys => Some("twincat"),
            Self::Iec | Self::Cscape | Self::Openplc | Self::Openplc4 | Self::Logix | Self::Siemens => None,
        }
    }

    pub fn named(name: &str) -> Option<Self> {
        Self::names().find(|it| it.0.eq_ignore_ascii_case(name)).map(|it| it.1)
    }

    /// The dialect with this name; the error is a sentence without a full stop.
    pub fn asked_for(name: &str) -> Result<Self, String> {
        let names = || Self::names().map(|it| it.0);
        Self::named(name).ok_or_else(|| match nearest(name, names()) {
            Some(near) => format!("there is no dialect `{name}`; did you mean `{near}`?"),
            None => {
                format!("there is no dialect `{name}`; the dialects are {}", names().collect::<Vec<_>>().join(", "))
            }
        })
    }

    /// Whose rules its variables follow, and whose blocks its bare names mean before those that all systems share.
    pub const fn family(self) -> Family {
        match self {
            Self::Iec => Family::Iec,
            Self::Cscape => Family::Cscape,
            Self::Codesys => Family::Codesys,
            Self::Openplc => Family::Openplc,
            Self::Openplc4 => Family::Openplc4,
            Self::Logix => Family::Logix,
            Self::Siemens => Family::S7,
        }
    }

    /// The standard block that a bare `name` means.
    pub fn block(self, name: &str) -> Option<&'static BlockInfo> {
        bare_block(self, name).map(|it| it.info())
    }

    /// METHODs use the VAR_IN_OUTs of the last call of their FUNCTION_BLOCK's body.
    pub(crate) fn keeps_in_outs(self) -> bool {
        self == Self::Codesys
    }

    /// An address is kept in a DWORD, and a pointer has the size of one.
    pub(crate) fn counts_addresses_as_dwords(self) -> bool {
        self == Self::Codesys
    }

    /// An input of ANY is the argument's class, address and size.
    pub(crate) fn hands_on_any(self) -> bool {
        self == Self::Codesys
    }

    /// `TYPE ABSTRACT Base : STRUCT`.
    pub(crate) fn has_abstract_types(self) -> bool {
        self == Self::Codesys
    }

    /// `__POUNAME()` and `__POSITION()`.
    pub(crate) fn has_pou_texts(self) -> bool {
        self == Self::Codesys
    }

    /// `__ISVALIDREF` takes a VAR_IN_OUT.
    pub(crate) fn has_in_outs_that_are_references(self) -> bool {
        self == Self::Codesys
    }

    /// A STRUCT may have no members.
    pub(crate) fn has_empty_structures(self) -> bool {
        self == Self::Codesys
    }

    /// `__TRY`.
    pub const fn handles_exceptions(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// `-a ** b` is `-(a ** b)`: a sign is applied after a power. (MOTION-RM002, "order of operations"; S7-1200 manual,
    /// "operators of SCL")
    pub const fn raises_before_signs(self) -> bool {
        matches!(self, Self::Logix | Self::Siemens)
    }

    /// The arguments of a call without names are in the order in which the parameters are declared, outputs among them.
    /// (IEC 61131-3, 6.6.1.4.2, "non-formal call")
    pub const fn binds_outputs_in_order(self) -> bool {
        matches!(self, Self::Iec | Self::Cscape | Self::Openplc | Self::Openplc4)
    }

    /// `JMP label`, and GOTO of SCL, which is read as that.
    pub const fn has_jumps(self) -> bool {
        matches!(self, Self::Codesys | Self::Siemens)
    }

    /// Sequential function charts as text.
    pub(crate) const fn has_charts(self) -> bool {
        matches!(self, Self::Iec | Self::Openplc)
    }

    /// Every block has ENO as an output that is read, `inst.ENO`.
    pub(crate) const fn has_enables_everywhere(self) -> bool {
        matches!(self, Self::Openplc | Self::Openplc4)
    }

    /// Every block has EN as an input that is read, `inst.EN`.
    pub(crate) const fn has_enabling_inputs(self) -> bool {
        matches!(self, Self::Openplc)
    }

    /// `%QX0.16` is `%QX2.0`: the buffers of OpenPLC's runtime are rows of eight bits, one after the other (`glue_generator.cpp`, which
    /// prints that it is wrong).
    pub(crate) const fn has_bits_beyond_bytes(self) -> bool {
        matches!(self, Self::Openplc)
    }

    /// `RETURN(condition)`.
    pub const fn returns_on_conditions(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// `:= ()`, an initial value that says nothing of any member.
    pub const fn has_empty_values(self) -> bool {
        matches!(self, Self::Siemens | Self::Codesys)
    }

    /// Initial values may name single elements, `(level[1] := 5)`, or give members by their positions, `(5, TRUE)`.
    pub const fn has_values_by_position(self) -> bool {
        matches!(self, Self::Siemens)
    }

    /// A file may hold one object as its editor shows it, without END_FUNCTION_BLOCK and its like.
    pub(crate) const fn exports_objects_without_ends(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// `delay.TON(…)` calls a timer or counter, by the instruction that it is the data of.
    pub const fn names_instructions(self) -> bool {
        matches!(self, Self::Siemens)
    }

    /// What a library declares is in a namespace of its own.
    pub const fn has_own_libraries(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// CONFIGURATION may be a name.
    pub const fn has_configurations_as_names(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// `10#15` is a number of base 10.
    pub const fn has_decimal_bases(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// `CHAR#16#80`, a character by its number.
    pub const fn has_numbered_characters(self) -> bool {
        matches!(self, Self::Siemens)
    }

    /// `Act;` calls an ACTION, as `Act();` does.
    pub const fn calls_actions_by_name(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// VAR_IN_OUT CONSTANT.
    pub const fn has_constant_in_outs(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// The standard's own habits, where a vendor has none.
    pub const fn is_standard(self) -> bool {
        matches!(self, Self::Iec | Self::Openplc | Self::Openplc4 | Self::Siemens)
    }

    /// Bit strings count as unsigned integers, and same-size sign changes are implicit.
    pub const fn mixes_bits_and_integers(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// AND, OR, XOR and NOT of integers work on their bits: the dialect has no bit strings.
    pub const fn has_bits_of_integers(self) -> bool {
        matches!(self, Self::Logix)
    }

    /// A DATE and a TIME are the day on which that time after midnight is.
    pub const fn adds_times_to_days(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A number becomes one of another type by itself, also where digits or high bits are lost.
    pub const fn converts_numbers(self) -> bool {
        matches!(self, Self::Logix)
    }

    /// Numbers, bit strings and BOOLs become one another where they are stored or passed, as in C++.
    pub const fn converts_as_cpp(self) -> bool {
        matches!(self, Self::Openplc4)
    }

    /// `p[i]` follows a POINTER TO.
    pub const fn indexes_pointers(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A member of a structure may be a single bit, of the type BIT.
    pub const fn has_bits(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A call of a FUNCTION gives every input that has no default.
    pub const fn wants_all_inputs(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// FUNCTIONs, and METHODs of one class, may have the same name if they differ in their parameters.
    pub const fn has_overloads(self) -> bool {
        !matches!(self, Self::Codesys)
    }

    /// TON, TOF and TP take an LTIME as well, as the standard overloads them.
    pub const fn overloads_timers(self) -> bool {
        self.is_standard()
    }

    /// A call of a block that names no input gives all of them.
    pub const fn wants_all_positions(self) -> bool {
        self.is_standard()
    }

    /// The internal variables of an instance may be read from outside.
    pub const fn shows_inner_variables(self) -> bool {
        matches!(self, Self::Codesys | Self::Openplc)
    }

    /// They may be written from outside, too: those of an instance DB, and in MATIEC all but outputs (`lvalue_check.cc`).
    pub const fn writes_inner_variables(self) -> bool {
        matches!(self, Self::Siemens | Self::Openplc)
    }

    /// `Press.MOST`, a CONSTANT by the name of its POU.
    pub const fn names_constants_of_units(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// ADR takes a CONSTANT, and a BIT of a UNION.
    pub const fn has_addresses_of_constants(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A PROPERTY may be a statement of its own, for what its GET does.
    pub const fn reads_properties_alone(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A REFERENCE TO is bound by `:=` in its declaration, too.
    pub const fn binds_by_assignment(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A STRING may have no characters, or more than LEN can count.
    pub const fn has_long_strings(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// `a [:=] b`: what is assigned so is set to 0 when the controller enters Run mode ("Specify a non-retentive assignment",
    /// MOTION-RM002H, p. 637; the type STRING is listed, too).
    pub const fn resets_assignments(self) -> bool {
        matches!(self, Self::Logix)
    }

    /// A VAR_IN_OUT may be declared with a value, which is not used: each call gives a variable.
    pub const fn has_values_of_in_outs(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A variable alone is a statement that does nothing.
    pub const fn takes_values_alone(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// METHODs of an instance's internal instances may be called from outside.
    pub const fn calls_inner_methods(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// An instance of a FUNCTION_BLOCK may be copied.
    pub const fn copies_instances(self) -> bool {
        matches!(self, Self::Codesys | Self::Siemens)
    }

    /// An instance of what EXTENDS a class may be assigned to one of the class, which takes what it has of it.
    pub const fn copies_bases_of_instances(self) -> bool {
        matches!(self, Self::Siemens)
    }

    /// An input of a FUNCTION_BLOCK's type takes an instance of what EXTENDS it.
    pub const fn gives_bases_of_instances(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// THIS is also available in a PROGRAM, for its variables and METHODs.
    pub const fn has_this_of_programs(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// `TO_USINT('0')` is the number of the character.
    pub const fn takes_literals_as_characters(self) -> bool {
        matches!(self, Self::Siemens)
    }

    /// `TRUNC` takes whole numbers, which it leaves as they are.
    pub const fn truncates_integers(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A text in single quotes after `WSTRING#` or `WCHAR#` is wide.
    pub const fn has_wide_texts_in_single_quotes(self) -> bool {
        matches!(self, Self::Siemens)
    }

    /// How a text of code units is written, with what is between its quotes.
    pub fn wide_text(self, ty: &str, inner: &str) -> String {
        match self.has_wide_texts_in_single_quotes() {
            true => format!("`{ty}#'{inner}'`"),
            false => format!("in double quotes: `\"{inner}\"`"),
        }
    }

    /// A PROGRAM may be called by its name, and its variables read.
    pub const fn calls_programs(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// Each size of address has registers of its own, so that `%IX0.0` and `%IW0` are two.
    pub const fn has_registers(self) -> bool {
        matches!(self, Self::Openplc | Self::Openplc4)
    }

    /// Nothing is assigned at an address of inputs, `%I`.
    pub const fn protects_inputs(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// SHL and SHR take integers besides bit strings.
    pub const fn shifts_integers(self) -> bool {
        matches!(self, Self::Codesys | Self::Siemens)
    }

    /// `T#5m68s`: S7 has `500h10000ms` among its examples (S7-1200 manual V4.2, table 5-32), and MATIEC adds the units. The
    /// standard, and CODESYS, let only the first unit overflow.
    pub const fn takes_lower_units_that_overflow(self) -> bool {
        matches!(self, Self::Siemens | Self::Openplc | Self::Openplc4 | Self::Logix)
    }

    /// SEL and MUX evaluate only the input that is chosen, and MUX takes the last one for a K beyond it.
    pub const fn chooses_inputs(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// The body of a FUNCTION or FUNCTION_BLOCK that declares an input EN, and no ENO, runs while EN is TRUE. MATIEC's C
    /// begins with `if (!EN) return`, and its PROGRAMs know no EN. In the other dialects such an input is like any other.
    pub const fn runs_while_enabled(self) -> bool {
        matches!(self, Self::Iec | Self::Openplc)
    }

    /// A POU's own EN and ENO are inputs and outputs like any other.
    pub const fn declares_plain_enable(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// CASE takes any elementary type that has labels, as edition 3 says: characters and texts, too.
    pub const fn selects_by_texts(self) -> bool {
        self.is_standard()
    }

    /// A bare name of a METHOD, in that METHOD itself, may mean a FUNCTION; the METHOD is called by THIS.
    pub const fn calls_own_by_this(self) -> bool {
        self.is_standard()
    }

    /// `word.START`, where START is a CONSTANT, is the bit that it counts.
    pub const fn selects_by_constants(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// A CONSTANT may be PERSISTENT, as the parameters of TwinCAT's building automation are (TF8040).
    pub const fn has_persistent_constants(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// `a := b := c` assigns to both: CODESYS, and SIMATIC as "multiple assignment".
    pub const fn assigns_in_a_row(self) -> bool {
        matches!(self, Self::Codesys | Self::Siemens)
    }

    /// An assignment in parentheses is a value.
    pub const fn assigns_in_expressions(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// `x : BOOL AT %QX0.0`, as OpenPLC Editor from v4 on writes it, and an alias in place of the address.
    pub(crate) const fn has_addresses_after_types(self) -> bool {
        matches!(self, Self::Openplc | Self::Openplc4)
    }

    /// An address in a section of CONSTANTs, of which the editor says nothing: what has one is a variable.
    pub(crate) const fn has_located_constants(self) -> bool {
        matches!(self, Self::Openplc | Self::Openplc4)
    }

    /// `a += b` and the like, which SIMATIC calls a combined assignment.
    pub const fn combines_assignments(self) -> bool {
        matches!(self, Self::Siemens)
    }

    /// An enumeration's value is a number where an index is asked for, and counts in a FOR.
    pub const fn counts_by_enumerations(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// Code uses the inputs of FUNCTIONs as variables: no lint is for what is a copy.
    pub const fn uses_inputs(self) -> bool {
        matches!(self, Self::Codesys | Self::Logix)
    }

    /// `EXPT` gives the type of its first parameter, as the standard says; in CODESYS it may give LREAL.
    pub const fn powers_have_type_of_base(self) -> bool {
        !matches!(self, Self::Codesys)
    }

    /// `ADD_INT` is ADD of INTs, as in the standard's tables.
    pub const fn has_typed_functions(self) -> bool {
        matches!(self, Self::Iec | Self::Openplc | Self::Openplc4)
    }

    /// A PROGRAM declares global variables, as in the standard's tables.
    pub const fn has_globals_of_programs(self) -> bool {
        matches!(self, Self::Iec | Self::Openplc | Self::Openplc4)
    }

    /// Lists of global variables have names, which are written before their variables: `GVL.x`.
    pub const fn names_lists(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// `AT %I*` needs no VAR_CONFIG: the configuration of the devices gives the address.
    pub const fn leaves_addresses_open(self) -> bool {
        matches!(self, Self::Codesys)
    }

    /// Assigning a FOR counter in its loop is a lint, not an error.
    pub const fn assigns_counters(self) -> bool {
        matches!(self, Self::Codesys | Self::Openplc4)
    }
}

/// All standard blocks by the names that lead to them, in the order of the table.
static BY_NAME: LazyLock<FxHashMap<Key<'static>, Vec<BlockId>>> = LazyLock::new(|| {
    let mut by_name: FxHashMap<_, Vec<_>> = FxHashMap::default();
    for (at, block) in BLOCKS.iter().enumerate() {
        for name in [Some(block.name), block.facts.alias].into_iter().flatten().filter(|it| block.is_named(it)) {
            by_name.entry(Key(name)).or_default().push(BlockId::next(at));
        }
    }
    by_name
});

fn block_named(name: &str, is_meant: impl Fn(&BlockInfo) -> bool) -> Option<BlockId> {
    BY_NAME.get(&Key(name))?.iter().copied().find(|it| is_meant(it.info()))
}

/// The block called `name` in `family`.
pub(crate) fn block_in(family: Family, name: &str) -> Option<BlockId> {
    block_named(name, |it| it.family == family)
}

/// What the bare `name` means under `dialect`, and what its family's name before it means: the
/// family's own block, or what all systems share.
pub(crate) fn bare_block(dialect: Dialect, name: &str) -> Option<BlockId> {
    block_in(dialect.family(), name).or_else(|| shared_block(name))
}

/// What reads the scan's time.
pub(crate) fn clock() -> Option<BlockId> {
    block_in(Family::Iec, "__CLOCK")
}

pub(crate) fn minor_fault() -> Option<BlockId> {
    block_in(Family::Iec, "__MINOR_FAULT")
}

pub(crate) fn shared_block(name: &str) -> Option<BlockId> {
    block_named(name, BlockInfo::is_shared)
}

/// What stands for a block while `is_on` holds for an option: another, or the block itself.
pub(crate) fn as_options_have_it(id: BlockId, is_on: impl Fn(BlockOption) -> bool) -> BlockId {
    let info = id.info();
    let replaces = |it: &BlockInfo| {
        let option = it.facts.option.filter(|it| is_on(it.option) && it.of == info.name);
        it.family == info.family && option.is_some()
    };
    BLOCKS.iter().position(replaces).map_or(id, BlockId::next)
}

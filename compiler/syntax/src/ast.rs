//! The syntax tree: mirrors the grammar, keeps comments, knows no meaning. Names are text.
//!
//! The parser limits nesting ([`MAX_DEPTH`]), so later passes may recurse freely.

use crate::source::Span;
pub use staunch_ir::{Chars, RefKind};
use staunch_runtime::Elementary;

/// Nesting of expressions and statements; types and initial values nest a quarter as deep.
pub const MAX_DEPTH: usize = 256;
/// Operands of one chain of binary operators, and branches of one IF.
pub const MAX_CHAIN: usize = 1000;

/// A name as the source spells it; comparison ignores case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name<'s> {
    pub text: &'s str,
    pub span: Span,
}

/// One source file.
#[derive(Clone, Debug, Default)]
pub struct File<'s> {
    pub items: Vec<Item<'s>>,
    /// Of its VAR_CONFIG outside of a CONFIGURATION.
    pub bindings: Vec<Binding<'s>>,
    /// Every `{…}` in the file, in order, without its braces.
    pub pragmas: Vec<Name<'s>>,
    /// Each `{Test}` and `{Test(x := 1)}` of them, with its arguments.
    pub test_pragmas: Vec<TestPragma<'s>>,
    /// The file as a whole, then the NAMESPACEs and POUs in it that change what a name means.
    pub regions: Vec<Region<'s>>,
    /// Each `{IF …}` that is decided when all declarations are known.
    pub undecided: Vec<Span>,
    /// The first name that is the word CONFIGURATION, which most dialects reserve.
    pub reserved: Option<Span>,
    /// For each `a += b`, which is read as `a := a + (b)`: what is reported where the dialect does not have it.
    pub combined: Vec<crate::Diagnostic>,
    /// What is reported of a unit that the end of the file ends, where the dialect does not have that.
    pub unclosed: Vec<crate::Diagnostic>,
    /// For each `x : BOOL AT %QX0.0` its address, and what is reported where the dialect does not have it.
    pub late_addresses: Vec<(Name<'s>, crate::Diagnostic)>,
    /// The targets of `a [:=] b`.
    pub nonretentive: Vec<Span>,
    /// The braces before code in C, `{{ … }}`.
    pub c_code: Vec<Span>,
    /// ACTIONs that no unit is before, each with what is reported where it is of none.
    pub apart: Vec<(Pou<'s>, crate::Diagnostic)>,
}

/// One test of the METHOD or FUNCTION after it, as Siemens AX has them.
#[derive(Clone, Debug)]
pub struct TestPragma<'s> {
    /// Without its braces.
    pub span: Span,
    pub arguments: Vec<Argument<'s>>,
}

/// `A.B.C`
pub type Path<'s> = Vec<Name<'s>>;

/// A stretch of a file in which a name may mean more than around it. What a NAMESPACE holds is among the
/// items of the file: where an item is says whose it is.
#[derive(Clone, Debug)]
pub struct Region<'s> {
    /// Of a NAMESPACE; what a file or a POU holds is in the namespace around it.
    pub path: Path<'s>,
    /// Of a NAMESPACE INTERNAL.
    pub internal: bool,
    /// What its USING directives name.
    pub uses: Vec<Path<'s>>,
    pub span: Span,
}

impl<'s> File<'s> {
    /// Whether a byte of a file is in a type, or in the declaration of a variable of a POU.
    pub fn is_in_declaration(&self, (file, at): (u16, u32)) -> bool {
        let holds = |it: Span| it.file == file && it.start <= at && at <= it.end;
        self.items.iter().any(|it| match it {
            Item::Pou(pou) | Item::Test(TestUnit { pou, .. }) => {
                let pous = core::iter::once(pou).chain(&pou.routines);
                pous.flat_map(|it| &it.blocks).flat_map(|it| &it.vars).any(|it| holds(it.span))
            }
            Item::Types(types) => types.iter().any(|it| holds(it.ty.span)),
            Item::Globals(_) | Item::Configuration(_) => false,
        })
    }

    /// Takes out the bodies of the POUs, in order, each with those of its routines after it: they can be let
    /// go when they have been checked.
    pub fn take_bodies(&mut self) -> impl Iterator<Item = Vec<Statement<'s>>> {
        let pous = self.items.iter_mut().filter_map(|it| match it {
            Item::Pou(pou) => Some(pou),
            Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
        });
        pous.flat_map(|pou| {
            let Pou { body, routines, .. } = pou;
            [body].into_iter().chain(routines.iter_mut().map(|it| &mut it.body)).map(std::mem::take)
        })
    }
}

#[derive(Clone, Debug)]
pub enum Item<'s> {
    Pou(Pou<'s>),
    Types(Vec<TypeDecl<'s>>),
    /// VAR_GLOBAL at file level.
    Globals(VarBlock<'s>),
    Configuration(Configuration<'s>),
    Test(TestUnit<'s>),
}

/// A part of a unit test: SETUP, TEARDOWN or TEST.
#[derive(Clone, Debug)]
pub struct TestUnit<'s> {
    pub part: TestPart,
    /// Its variables and statements. The name is a TEST's title, a string literal as it is spelled.
    pub pou: Pou<'s>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestPart {
    Setup,
    Teardown,
    Test,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PouKind {
    Program,
    FunctionBlock,
    /// A FUNCTION_BLOCK without a body.
    Class,
    /// Heads of METHODs and PROPERTYs that a class has.
    Interface,
    Function,
    /// A TEST, with what SETUP and TEARDOWN add to it.
    Test,
    /// A further body of a PROGRAM or FUNCTION_BLOCK.
    Action,
    Method,
    /// What a PROPERTY gives where it is read: its name is its result.
    Getter,
    /// What a PROPERTY does with a value that is assigned to it: its name is an input.
    Setter,
}

impl PouKind {
    /// The keyword.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Program => "PROGRAM",
            Self::FunctionBlock => "FUNCTION_BLOCK",
            Self::Class => "CLASS",
            Self::Interface => "INTERFACE",
            Self::Function => "FUNCTION",
            Self::Test => "TEST",
            Self::Action => "ACTION",
            Self::Method => "METHOD",
            Self::Getter | Self::Setter => "PROPERTY",
        }
    }

    /// Whether its variables live for one call, and its name is its result.
    pub const fn is_function(self) -> bool {
        match self {
            Self::Function | Self::Method | Self::Getter | Self::Setter => true,
            Self::Program | Self::FunctionBlock | Self::Class | Self::Interface | Self::Test | Self::Action => false,
        }
    }

    /// Whether instances of it can be declared.
    pub const fn is_block(self) -> bool {
        match self {
            Self::FunctionBlock | Self::Class => true,
            Self::Program | Self::Interface | Self::Function | Self::Test | Self::Action => false,
            Self::Method | Self::Getter | Self::Setter => false,
        }
    }

    /// Whether it has METHODs, ACTIONs and PROPERTYs.
    pub const fn has_routines(self) -> bool {
        matches!(self, Self::Program | Self::Interface) || self.is_block()
    }
}

/// The words before a METHOD's name, or a POU's.
#[derive(Clone, Copy, Debug, Default)]
pub struct Modifiers {
    pub access: Option<(Access, Span)>,
    pub is_final: Option<Span>,
    pub is_abstract: Option<Span>,
    pub overrides: Option<Span>,
    /// A second word of from where it may be used.
    pub again: Option<Span>,
}

impl Modifiers {
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            access: self.access.or(other.access),
            is_final: self.is_final.or(other.is_final),
            is_abstract: self.is_abstract.or(other.is_abstract),
            overrides: self.overrides.or(other.overrides),
            again: self.again.or(other.again),
        }
    }
}

/// From where something may be named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    Public,
    Private,
    Protected,
    Internal,
}

impl Access {
    pub const fn word(self) -> &'static str {
        match self {
            Self::Public => "PUBLIC",
            Self::Private => "PRIVATE",
            Self::Protected => "PROTECTED",
            Self::Internal => "INTERNAL",
        }
    }
}

#[derive(Clone, Debug)]
pub struct Pou<'s> {
    pub kind: PouKind,
    pub name: Name<'s>,
    pub modifiers: Modifiers,
    /// What a class EXTENDS.
    pub extends: Option<Name<'s>>,
    /// What a class IMPLEMENTS, or an INTERFACE EXTENDS.
    pub implements: Vec<Name<'s>>,
    /// The names after EXTENDS and IMPLEMENTS as they are written.
    pub bases: Vec<Path<'s>>,
    /// How many of the VAR blocks are the base's.
    pub inherited: usize,
    /// Of an inherited routine: the class whose it is.
    pub home: Option<Name<'s>>,
    /// An inherited routine that is overridden: only SUPER names it.
    pub is_hidden: bool,
    /// The result type of a FUNCTION or METHOD, which may have none.
    pub result: Option<TypeSpec<'s>>,
    pub blocks: Vec<VarBlock<'s>>,
    pub body: Vec<Statement<'s>>,
    /// What is its body instead, until that is written out.
    pub chart: Option<Box<Chart<'s>>>,
    /// The METHODs and ACTIONs of a PROGRAM or FUNCTION_BLOCK.
    pub routines: Vec<Pou<'s>>,
    /// What `{attribute '…'}` says before it.
    pub attributes: Vec<&'s str>,
    /// `{external}` before it: it is implemented outside of Structured Text.
    pub external: Option<External<'s>>,
    /// A library declares it, and nothing says what it does.
    pub is_stub: bool,
    /// `{pool …}` before it.
    pub pool: Option<Pool>,
    /// The comment that is directly before the POU, cleaned of its marks.
    pub doc: Option<String>,
    /// The head, up to the name.
    pub span: Span,
    /// From there to its END_.
    pub extent: Span,
}

/// `{external}`, or `{external 'symbol'}`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct External<'s> {
    /// What C calls it; else its own name.
    pub symbol: Option<&'s str>,
    pub span: Span,
}

impl Pool {
    /// The number in `pool 16`; the inner `None` where that is none.
    pub fn count_in(pragma: &str) -> Option<Option<u32>> {
        let text = pragma.trim();
        let (word, rest) = text.split_at_checked("pool".len())?;
        let is_it =
            word.eq_ignore_ascii_case("pool") && !rest.starts_with(|it: char| it.is_alphanumeric() || it == '_');
        is_it.then(|| rest.trim().parse().ok())
    }
}

/// `{pool 16}`: how many objects of a type `__NEW` can have made at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pool {
    /// `None` if it is not a number.
    pub count: Option<u32>,
    pub span: Span,
}

impl<'s> Pou<'s> {
    /// The declarations of its own CONSTANTs.
    pub fn constants(&self) -> impl Iterator<Item = &VarBlock<'s>> {
        self.blocks.iter().filter(|it| it.has_values() && it.kind != VarKind::External)
    }

    /// One without variables and statements.
    pub fn new(kind: PouKind, name: Name<'s>, span: Span) -> Self {
        Self {
            kind,
            name,
            modifiers: Modifiers::default(),
            extends: None,
            implements: Vec::new(),
            bases: Vec::new(),
            inherited: 0,
            home: None,
            is_hidden: false,
            result: None,
            blocks: Vec::new(),
            body: Vec::new(),
            chart: None,
            routines: Vec::new(),
            attributes: Vec::new(),
            external: None,
            is_stub: false,
            pool: None,
            doc: None,
            span,
            extent: span,
        }
    }
}

/// The steps and transitions of a PROGRAM or FUNCTION_BLOCK, whose ACTIONs are among its routines.
#[derive(Clone, Debug)]
pub struct Chart<'s> {
    pub steps: Vec<Step<'s>>,
    pub transitions: Vec<Transition<'s>>,
    /// The word that opens its first part.
    pub span: Span,
}

/// `INITIAL_STEP Start: Fill(N); END_STEP`
#[derive(Clone, Debug)]
pub struct Step<'s> {
    pub name: Name<'s>,
    pub is_initial: bool,
    pub associations: Vec<Association<'s>>,
}

/// `Fill(L, T#5s)`: what a step does with an ACTION, or with a BOOL variable.
#[derive(Clone, Debug)]
pub struct Association<'s> {
    pub action: Name<'s>,
    /// None where it is not written: `Fill();`
    pub qualifier: Option<Qualifier>,
    /// Of a qualifier that has one.
    pub time: Option<Expr<'s>>,
    pub span: Span,
}

/// How a step and an action are associated (IEC 61131-3, table 57).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Qualifier {
    /// N: while the step is active.
    While,
    /// R
    Reset,
    /// S
    Set,
    /// L: while the step is active, for at most a time.
    Limited,
    /// D: while the step is active, from a time on.
    Delayed,
    /// P and P1: as the step becomes active.
    Entered,
    /// P0: as the step is left.
    Left,
    /// SD: set after a time, whether the step is active then or not.
    SetDelayed,
    /// DS: set after a time, where the step is still active.
    DelayedSet,
    /// SL: set for a time.
    SetLimited,
}

impl Qualifier {
    const NAMED: [(&'static str, Self); 11] = [
        ("N", Self::While),
        ("R", Self::Reset),
        ("S", Self::Set),
        ("P", Self::Entered),
        ("P0", Self::Left),
        ("P1", Self::Entered),
        ("L", Self::Limited),
        ("D", Self::Delayed),
        ("SD", Self::SetDelayed),
        ("DS", Self::DelayedSet),
        ("SL", Self::SetLimited),
    ];

    pub fn named(name: &str) -> Option<Self> {
        Self::NAMED.iter().find(|it| it.0.eq_ignore_ascii_case(name)).map(|it| it.1)
    }

    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::NAMED.iter().map(|it| it.0)
    }

    /// Whether a time belongs to it.
    pub const fn is_timed(self) -> bool {
        match self {
            Self::Limited | Self::Delayed | Self::SetDelayed | Self::DelayedSet | Self::SetLimited => true,
            Self::While | Self::Reset | Self::Set | Self::Entered | Self::Left => false,
        }
    }
}

/// `TRANSITION (PRIORITY := 1) FROM (a, b) TO c := x > 3; END_TRANSITION`
#[derive(Clone, Debug)]
pub struct Transition<'s> {
    /// The lowest number comes first.
    pub priority: Option<u64>,
    pub from: Vec<Name<'s>>,
    pub to: Vec<Name<'s>>,
    pub condition: Expr<'s>,
    /// Its first word.
    pub span: Span,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VarKind {
    Var,
    Input,
    Output,
    InOut,
    Temp,
    Stat,
    /// Of a METHOD: one for each instance.
    Inst,
    Global,
    External,
}

#[derive(Clone, Debug)]
pub struct VarBlock<'s> {
    pub kind: VarKind,
    pub constant: Option<Span>,
    pub retain: Option<Span>,
    pub non_retain: Option<Span>,
    pub persistent: Option<Span>,
    pub access: Option<(Access, Span)>,
    pub vars: Vec<VarDecl<'s>>,
    /// The keyword that opens the block.
    pub span: Span,
}

impl VarBlock<'_> {
    /// One without qualifiers and variables.
    pub fn new(kind: VarKind, span: Span) -> Self {
        let (constant, retain, non_retain, persistent, access) = (None, None, None, None, None);
        Self { kind, constant, retain, non_retain, persistent, access, vars: Vec::new(), span }
    }

    /// Whether its variables are CONSTANTs whose values are declared. What a caller gives is only read.
    pub fn has_values(&self) -> bool {
        self.constant.is_some() && !matches!(self.kind, VarKind::Input | VarKind::InOut)
    }
}

/// The attribute of a FUNCTION_BLOCK and its inputs that start anew at each call.
pub const AT_CALLS: &str = "initialize_on_call";

/// `a, b AT %IX0.0 : BOOL R_EDGE := TRUE;`
#[derive(Clone, Debug)]
pub struct VarDecl<'s> {
    pub names: Vec<Name<'s>>,
    pub address: Option<Name<'s>>,
    pub ty: TypeSpec<'s>,
    pub edge: Option<(Edge, Span)>,
    pub construction: Option<Box<Construction<'s>>>,
    pub initial: Option<Initial<'s>>,
    /// Of a member of a TYPE: an address as its initial value, which is assigned as a variable of the TYPE starts. Of an input
    /// that starts anew at calls: what its instance starts with.
    pub started: Option<Initial<'s>>,
    /// `{attribute 'instance-path'}`: it starts with the path of its instance.
    pub instance_path: Option<Span>,
    /// `{attribute 'initialize_on_call'}`: an input that a call does not give starts anew.
    pub starts_at_calls: bool,
    /// The comment on the declaration's line or directly before it.
    pub doc: Option<String>,
    pub span: Span,
}

impl<'s> VarDecl<'s> {
    /// Variables with nothing but a type.
    pub fn new(names: Vec<Name<'s>>, ty: TypeSpec<'s>, span: Span) -> Self {
        Self {
            names,
            address: None,
            ty,
            edge: None,
            construction: None,
            initial: None,
            started: None,
            instance_path: None,
            starts_at_calls: false,
            doc: None,
            span,
        }
    }

    /// The address, unless a VAR_CONFIG gives it: `AT %I*`.
    pub fn known_address(&self) -> Option<Name<'s>> {
        self.address.filter(|it| !it.text.ends_with('*'))
    }
}

/// What a declaration gives to the FB_init of its instances: `Motor(limit := 5)`, `ARRAY[1..2] OF Motor[(5), (6)]`.
#[derive(Clone, Debug)]
pub struct Construction<'s> {
    /// One list, or one for each element of an array.
    pub lists: Vec<Vec<Argument<'s>>>,
    pub is_of_elements: bool,
    pub span: Span,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    Rising,
    Falling,
}

#[derive(Clone, Debug)]
pub struct TypeSpec<'s> {
    pub kind: TypeKind<'s>,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum TypeKind<'s> {
    /// An elementary type, a user's, or a block, possibly qualified: `CODESYS.CTU`. A family or
    /// namespace comes first.
    Named(Vec<Name<'s>>),
    /// `STRING`, `STRING[80]`, `STRING(80)`, and the same for WSTRING.
    String { wide: bool, capacity: Option<Box<Expr<'s>>> },
    /// `INT (0..100)`, also on a named base.
    Subrange { base: Name<'s>, low: Box<Expr<'s>>, high: Box<Expr<'s>> },
    /// `ARRAY[1..3, 0..4] OF T`; an empty list is `ARRAY[*]`.
    Array { bounds: Vec<Bound<'s>>, element: Box<TypeSpec<'s>> },
    /// `STRUCT … END_STRUCT`
    Struct(Vec<VarDecl<'s>>),
    /// `(Red, Green := 5) INT`, also `INT (Red, Green)`.
    Enum { base: Option<Name<'s>>, values: Vec<EnumValue<'s>> },
    /// `REF_TO T`, `POINTER TO T`, `REFERENCE TO T`
    Reference { kind: RefKind, target: Box<TypeSpec<'s>> },
    /// `UNION … END_UNION`, `STRUCT OVERLAP … END_STRUCT`: its members share their bytes.
    Union(Vec<VarDecl<'s>>),
    /// A type that did not parse or is not analysed any further; reported.
    Error,
}

#[derive(Clone, Debug)]
pub enum Bound<'s> {
    Range(Expr<'s>, Expr<'s>),
    /// `*`
    Open(Span),
}

#[derive(Clone, Debug)]
pub struct EnumValue<'s> {
    pub name: Name<'s>,
    pub value: Option<Expr<'s>>,
    pub doc: Option<String>,
}

#[derive(Clone, Debug)]
pub struct TypeDecl<'s> {
    pub name: Name<'s>,
    /// In a `TYPE INTERNAL`.
    pub internal: bool,
    /// ABSTRACT before the name.
    pub is_abstract: Option<Span>,
    /// The structure that a structure EXTENDS.
    pub base: Option<Path<'s>>,
    /// What `{attribute '…'}` says before TYPE, or before the type itself.
    pub attributes: Vec<&'s str>,
    /// `{pool …}` there.
    pub pool: Option<Pool>,
    /// `{attribute 'pack_mode' := '1'}` there: to how many bytes members are aligned at most, and where that is said.
    pub pack: Option<(u64, Span)>,
    pub ty: TypeSpec<'s>,
    pub initial: Option<Initial<'s>>,
    pub doc: Option<String>,
    /// All names in a declaration that did not parse: they may be enumerators.
    pub unread: Vec<Name<'s>>,
}

impl<'s> TypeDecl<'s> {
    /// A name for a type, and no more.
    pub fn new(name: Name<'s>, ty: TypeSpec<'s>) -> Self {
        Self {
            name,
            internal: false,
            is_abstract: None,
            base: None,
            attributes: Vec::new(),
            pool: None,
            pack: None,
            ty,
            initial: None,
            doc: None,
            unread: Vec::new(),
        }
    }
}

/// An initial value. `(a := 1)` is `Fields`; `[4(0), 1]` is `Elements`.
#[derive(Clone, Debug)]
pub struct Initial<'s> {
    pub kind: InitialKind<'s>,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum InitialKind<'s> {
    Value(Expr<'s>),
    Elements(Vec<Element<'s>>),
    Fields(Vec<(Name<'s>, Initial<'s>)>),
    /// `a[1] := x, a[2] := y` in [`InitialKind::Fields`]: elements of the member `a`, by their indices.
    Indexed(Vec<(Vec<Expr<'s>>, Initial<'s>)>),
    /// `(x, y)`: the values of the first members.
    Members(Vec<Initial<'s>>),
    /// `REF= x`
    Bind(Expr<'s>),
}

/// `x`, or `n(x, y, …)`: the values `count` times over. A repeat without values, `4()`, repeats
/// the element type's own initial value.
#[derive(Clone, Debug)]
pub struct Element<'s> {
    pub count: Option<Expr<'s>>,
    pub values: Vec<Initial<'s>>,
}

#[derive(Clone, Debug)]
pub struct Configuration<'s> {
    pub name: Name<'s>,
    pub globals: Vec<VarBlock<'s>>,
    pub resources: Vec<Resource<'s>>,
    /// Of all its VAR_CONFIG.
    pub bindings: Vec<Binding<'s>>,
    pub span: Span,
}

/// `Run.valve.open AT %QX0.1 : BOOL := FALSE;` in a VAR_CONFIG; without an address it has an initial value.
#[derive(Clone, Debug)]
pub struct Binding<'s> {
    /// `Run.valve.open`
    pub target: Expr<'s>,
    /// The variable at the address, which is its name; without an address, the variable's initial value.
    pub located: VarDecl<'s>,
}

/// A RESOURCE; tasks and programs that are directly in a CONFIGURATION make one without a name.
#[derive(Clone, Debug, Default)]
pub struct Resource<'s> {
    pub name: Option<Name<'s>>,
    pub globals: Vec<VarBlock<'s>>,
    pub tasks: Vec<Task<'s>>,
    pub programs: Vec<ProgramInstance<'s>>,
    pub bindings: Vec<Binding<'s>>,
}

/// `TASK t (INTERVAL := T#20ms, PRIORITY := 1);`
#[derive(Clone, Debug)]
pub struct Task<'s> {
    pub name: Name<'s>,
    pub properties: Vec<(Name<'s>, Expr<'s>)>,
}

/// `PROGRAM main WITH t : Main(x := g, y => h);`
#[derive(Clone, Debug)]
pub struct ProgramInstance<'s> {
    pub name: Name<'s>,
    pub task: Option<Name<'s>>,
    /// The namespace that its PROGRAM is in, as far as it is written.
    pub namespace: Path<'s>,
    pub program: Name<'s>,
    /// What its parameters are connected with.
    pub connections: Vec<Argument<'s>>,
}

#[derive(Clone, Debug)]
pub struct Statement<'s> {
    pub kind: StatementKind<'s>,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum StatementKind<'s> {
    /// `;`
    Empty,
    /// `a := b`
    Assign {
        target: Expr<'s>,
        value: Expr<'s>,
    },
    /// `a := b := c`, with the targets as written, two or more.
    AssignAll {
        targets: Vec<Expr<'s>>,
        value: Expr<'s>,
    },
    /// `a S= b` (set) and `a R= b` (reset).
    SetReset {
        target: Expr<'s>,
        value: Expr<'s>,
        set: bool,
    },
    /// `a S= b R= c`, two or more targets as written, each with whether it is set.
    SetResetAll {
        targets: Vec<(Expr<'s>, bool)>,
        value: Expr<'s>,
    },
    /// `a REF= b`
    Bind {
        target: Expr<'s>,
        value: Expr<'s>,
    },
    /// `a ?= b`
    Attempt {
        target: Expr<'s>,
        value: Expr<'s>,
    },
    /// An expression that is alone; only a call has a meaning there.
    Expr(Expr<'s>),
    /// IF and ELSIF branches, and ELSE.
    If {
        branches: Vec<(Expr<'s>, Vec<Statement<'s>>)>,
        otherwise: Option<Vec<Statement<'s>>>,
    },
    Case {
        selector: Expr<'s>,
        arms: Vec<Arm<'s>>,
        otherwise: Option<Vec<Statement<'s>>>,
    },
    For {
        counter: Box<Expr<'s>>,
        from: Box<Expr<'s>>,
        to: Box<Expr<'s>>,
        by: Option<Box<Expr<'s>>>,
        body: Vec<Statement<'s>>,
    },
    While {
        condition: Expr<'s>,
        body: Vec<Statement<'s>>,
    },
    Repeat {
        body: Vec<Statement<'s>>,
        until: Expr<'s>,
    },
    Try(Box<Try<'s>>),
    /// `name:`, the target of a jump.
    Label(Name<'s>),
    /// `JMP name`
    Jump(Name<'s>),
    Exit,
    Continue,
    Return,
    /// `RETURN(condition)`
    ReturnIf(Expr<'s>),
    /// What recovery put in place of something that did not parse; it has been reported.
    Error,
}

/// `__TRY … __CATCH(exception) … __FINALLY … __ENDTRY`
#[derive(Clone, Debug)]
pub struct Try<'s> {
    /// `__TRY`
    pub word: Span,
    pub body: Vec<Statement<'s>>,
    /// What `__CATCH` gives the number of the exception.
    pub exception: Option<Expr<'s>>,
    pub handler: Vec<Statement<'s>>,
    pub finally: Option<Finally<'s>>,
}

#[derive(Clone, Debug)]
pub struct Finally<'s> {
    /// Of the word.
    pub word: Span,
    pub body: Vec<Statement<'s>>,
}

#[derive(Clone, Debug)]
pub struct Arm<'s> {
    pub labels: Vec<Label<'s>>,
    pub body: Vec<Statement<'s>>,
}

#[derive(Clone, Debug)]
pub struct Label<'s> {
    pub low: Expr<'s>,
    pub high: Option<Expr<'s>>,
}

#[derive(Clone, Debug)]
pub struct Expr<'s> {
    pub kind: ExprKind<'s>,
    pub span: Span,
}

impl<'s> Expr<'s> {
    /// The first name of a path.
    pub fn first_name(&self) -> Option<Name<'s>> {
        match &self.kind {
            ExprKind::Name(name) => Some(*name),
            ExprKind::Member(owner, _) => owner.first_name(),
            _ => None,
        }
    }

    /// The variable that a member or an element is of: `a` of `a.b[1].c`.
    pub fn variable(&self) -> Option<Name<'s>> {
        match &self.kind {
            ExprKind::Member(owner, _) | ExprKind::Index(owner, _) => owner.variable(),
            _ => self.first_name(),
        }
    }

    /// `a.b.c`, where it is that: names and points.
    pub fn path(&self) -> Option<Path<'s>> {
        match &self.kind {
            ExprKind::Name(name) => Some(vec![*name]),
            ExprKind::Member(owner, name) => {
                let mut path = owner.path()?;
                path.push(*name);
                Some(path)
            }
            _ => None,
        }
    }
}

impl Expr<'_> {
    /// The expression in its parentheses.
    pub fn bare(&self) -> &Self {
        match &self.kind {
            ExprKind::Paren(inner) => inner.bare(),
            _ => self,
        }
    }
}

#[derive(Clone, Debug)]
pub enum ExprKind<'s> {
    Literal(Literal<'s>),
    Name(Name<'s>),
    /// `%IX0.0`, as spelled.
    Address(Name<'s>),
    /// `a.b`
    Member(Box<Expr<'s>>, Name<'s>),
    /// `a.3`, `a.%X3`, `a.%B1`: the text after the point.
    Part(Box<Expr<'s>>, Name<'s>),
    /// `a[i, j]`
    Index(Box<Expr<'s>>, Vec<Expr<'s>>),
    /// `a^`
    Deref(Box<Expr<'s>>),
    /// `f(…)`, `instance(…)`, `array[i](…)`
    Call(Box<Expr<'s>>, Vec<Argument<'s>>),
    Unary(UnaryOp, Box<Expr<'s>>),
    /// The operator's own span is kept for messages.
    Binary(Box<[Expr<'s>; 2]>, BinaryOp, Span),
    /// `( … )`: kept, since it ends a chain.
    Paren(Box<Expr<'s>>),
    /// `a := b` in a condition or in brackets: the target, the value, and the place of `:=`.
    Assign(Box<[Expr<'s>; 2]>, Span),
    /// What did not parse, or means nothing, and the parts of it that may hold more mistakes. It
    /// has been reported.
    Error(Vec<Expr<'s>>),
}

#[derive(Clone, Debug)]
pub struct Argument<'s> {
    pub kind: ArgumentKind<'s>,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum ArgumentKind<'s> {
    /// `x`
    Positional(Expr<'s>),
    /// `IN := x`
    Input(Name<'s>, Expr<'s>),
    /// `OUT => x`, `NOT OUT => x`; the variable may be missing: `OUT => `.
    Output { name: Name<'s>, negated: bool, target: Option<Expr<'s>> },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOp {
    Neg,
    Plus,
    Not,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOp {
    Power,
    Mul,
    Div,
    Mod,
    Add,
    Sub,
    Lt,
    Gt,
    Le,
    Ge,
    Eq,
    Ne,
    And,
    AndThen,
    Xor,
    Or,
    OrElse,
}

impl BinaryOp {
    /// As Structured Text writes it.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Power => "**",
            Self::Mul => "*",
            Self::Div => "/",
            Self::Mod => "MOD",
            Self::Add => "+",
            Self::Sub => "-",
            Self::Lt => "<",
            Self::Gt => ">",
            Self::Le => "<=",
            Self::Ge => ">=",
            Self::Eq => "=",
            Self::Ne => "<>",
            Self::And => "AND",
            Self::AndThen => "AND_THEN",
            Self::Xor => "XOR",
            Self::Or => "OR",
            Self::OrElse => "OR_ELSE",
        }
    }
}

/// A literal: its value, and the type a prefix gave it (`INT#5`, `Color#Red`).
#[derive(Clone, Debug)]
pub struct Literal<'s> {
    pub prefix: Option<Box<Name<'s>>>,
    pub value: LiteralValue<'s>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum LiteralValue<'s> {
    Bool(bool),
    /// The magnitude; a sign is an operator. `based` when written `16#FF`. Values above
    /// `u64::MAX` have been reported by the parser.
    Integer {
        value: u64,
        based: bool,
    },
    /// The digits as spelled, without `_`: they are read at the width their place asks for.
    Real(Box<str>),
    /// A duration, a date or a time of day, as its type carries it.
    Time {
        ty: Elementary,
        nanoseconds: i64,
    },
    /// `'…'` or `"…"`, escapes resolved.
    String(Box<Chars>),
    /// After `Color#`.
    Enumerator(Box<Name<'s>>),
    /// A literal that cannot be read; reported.
    Error,
}

/// Calls `see` with each list of statements that a statement holds.
pub fn each_body<'a, 's>(statement: &'a Statement<'s>, see: &mut dyn FnMut(&'a [Statement<'s>])) {
    match &statement.kind {
        StatementKind::If { branches, otherwise } => {
            branches.iter().for_each(|(_, body)| see(body));
            otherwise.iter().for_each(|it| see(it));
        }
        StatementKind::Case { arms, otherwise, .. } => {
            arms.iter().for_each(|arm| see(&arm.body));
            otherwise.iter().for_each(|it| see(it));
        }
        StatementKind::For { body, .. } | StatementKind::While { body, .. } | StatementKind::Repeat { body, .. } => {
            see(body);
        }
        StatementKind::Try(it) => {
            see(&it.body);
            see(&it.handler);
            it.finally.iter().for_each(|it| see(&it.body));
        }
        StatementKind::Empty
        | StatementKind::Assign { .. }
        | StatementKind::AssignAll { .. }
        | StatementKind::SetReset { .. }
        | StatementKind::SetResetAll { .. }
        | StatementKind::Bind { .. }
        | StatementKind::Attempt { .. }
        | StatementKind::Expr(_)
        | StatementKind::Label(_)
        | StatementKind::Jump(_)
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::Return
        | StatementKind::ReturnIf(_)
        | StatementKind::Error => {}
    }
}

/// Calls `see` with each statement, at any depth.
pub fn each_statement<'a, 's>(statements: &'a [Statement<'s>], see: &mut dyn FnMut(&'a Statement<'s>)) {
    for statement in statements {
        see(statement);
        each_body(statement, &mut |body| each_statement(body, see));
    }
}

/// Calls `visit` with every expression in the statements, outer ones first.
pub fn each_expr<'a, 's>(statements: &'a [Statement<'s>], visit: &mut dyn FnMut(&'a Expr<'s>)) {
    for statement in statements {
        match &statement.kind {
            StatementKind::Empty
            | StatementKind::Label(_)
            | StatementKind::Jump(_)
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Error => {}
            StatementKind::ReturnIf(condition) => each_part(condition, visit),
            StatementKind::Assign { target, value }
            | StatementKind::SetReset { target, value, .. }
            | StatementKind::Bind { target, value }
            | StatementKind::Attempt { target, value } => {
                each_part(target, visit);
                each_part(value, visit);
            }
            StatementKind::AssignAll { targets, value } => {
                targets.iter().chain([value]).for_each(|it| each_part(it, visit));
            }
            StatementKind::SetResetAll { targets, value } => {
                targets.iter().map(|it| &it.0).chain([value]).for_each(|it| each_part(it, visit));
            }
            StatementKind::Expr(expr) => each_part(expr, visit),
            StatementKind::If { branches, otherwise } => {
                for (condition, body) in branches {
                    each_part(condition, visit);
                    each_expr(body, visit);
                }
                each_expr(otherwise.as_deref().unwrap_or_default(), visit);
            }
            StatementKind::Case { selector, arms, otherwise } => {
                each_part(selector, visit);
                arms.iter().for_each(|arm| each_expr(&arm.body, visit));
                each_expr(otherwise.as_deref().unwrap_or_default(), visit);
            }
            StatementKind::For { counter, from, to, by, body } => {
                [counter, from, to].into_iter().chain(by).for_each(|it| each_part(it, visit));
                each_expr(body, visit);
            }
            StatementKind::While { condition, body } => {
                each_part(condition, visit);
                each_expr(body, visit);
            }
            StatementKind::Repeat { body, until } => {
                each_expr(body, visit);
                each_part(until, visit);
            }
            StatementKind::Try(it) => {
                each_expr(&it.body, visit);
                it.exception.iter().for_each(|it| each_part(it, visit));
                each_expr(&it.handler, visit);
                it.finally.iter().for_each(|it| each_expr(&it.body, visit));
            }
        }
    }
}

/// Calls `visit` with the expression and every one in it, outer ones first.
pub fn each_part<'a, 's>(expr: &'a Expr<'s>, visit: &mut dyn FnMut(&'a Expr<'s>)) {
    visit(expr);
    match &expr.kind {
        ExprKind::Literal(_) | ExprKind::Name(_) | ExprKind::Address(_) => {}
        ExprKind::Member(inner, _)
        | ExprKind::Part(inner, _)
        | ExprKind::Deref(inner)
        | ExprKind::Unary(_, inner)
        | ExprKind::Paren(inner) => each_part(inner, visit),
        ExprKind::Index(base, indices) => {
            each_part(base, visit);
            indices.iter().for_each(|it| each_part(it, visit));
        }
        ExprKind::Error(parts) => parts.iter().for_each(|it| each_part(it, visit)),
        ExprKind::Call(callee, arguments) => {
            each_part(callee, visit);
            for argument in arguments {
                match &argument.kind {
                    ArgumentKind::Positional(value) | ArgumentKind::Input(_, value) => each_part(value, visit),
                    ArgumentKind::Output { target, .. } => target.iter().for_each(|it| each_part(it, visit)),
                }
            }
        }
        ExprKind::Binary(sides, ..) | ExprKind::Assign(sides, _) => sides.iter().for_each(|it| each_part(it, visit)),
    }
}

/// The trees of a large program fill a good part of the memory that checking takes.
#[cfg(target_pointer_width = "64")]
const _: () = {
    assert!(size_of::<Expr<'_>>() <= 64);
    assert!(size_of::<Statement<'_>>() <= 152);
    assert!(size_of::<Argument<'_>>() <= 120);
};

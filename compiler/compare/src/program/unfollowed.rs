//! Where a program uses what its system computes otherwise than it is computed here: the rules that are known and not
//! followed.

use super::flow::{Range, Ranges};
use super::moving_preset;
use super::walked::Name;
use staunch_frontend::Dialect;
use staunch_frontend::rules::{EDGES, NOT_FOLLOWED, Part, Use};
use staunch_ir::{
    Argument, Expr, ExprKind, Field, FieldId, Place, Program, Projection, Root, Section, StatementKind, TextOp, Type,
    visit,
};
use staunch_runtime::Time;
use staunch_runtime::time::MILLISECOND;
use std::cell::OnceCell;
use std::collections::HashMap;

/// A sentence for each rule that the program's source uses, or whose type it is given from outside, or that its cycle in
/// nanoseconds asks for.
///
/// `starts` are the values of variables at the start.
pub fn find(program: &Program, dialect: Dialect, cycle: Time, starts: &HashMap<Name, Range>) -> Vec<String> {
    let rows = NOT_FOLLOWED.iter().filter(|it| it.dialect == dialect);
    let harmless = Harmless::of(program, starts);
    let found = rows.filter_map(|row| {
        let is_moving = row.uses == Use::Part(Part::MovingPreset);
        let moving = || is_moving.then(|| moving_preset::line(program, starts)).flatten();
        let of_timers = || timer(program, row.uses).filter(|_| cycle % MILLISECOND != 0);
        let copied = || copied_in_out(program, row.uses);
        let line = used(program, row.uses).or_else(of_timers).or_else(moving).or_else(copied)?;
        if harmless.has(row.uses) {
            return None;
        }
        let system = dialect.name().to_ascii_uppercase();
        Some(format!(
            "{} of {system}, which Staunch does not follow and line {line} uses: {} ({})",
            row.uses.words(),
            row.what,
            row.evidence
        ))
    });
    found.collect()
}

/// What no use leads to of what a system does otherwise, by what the program's numbers may be.
struct Harmless<'p> {
    program: &'p Program,
    starts: &'p HashMap<Name, Range>,
    ranges: OnceCell<Ranges<'p>>,
}

impl<'p> Harmless<'p> {
    fn of(program: &'p Program, starts: &'p HashMap<Name, Range>) -> Self {
        Self { program, starts, ranges: OnceCell::new() }
    }

    fn has(&self, uses: Use) -> bool {
        let ranges = || self.ranges.get_or_init(|| Ranges::of(self.program, self.starts));
        match uses {
            Use::Part(Part::LimitOfType) => !ranges().reach_limits(),
            Use::Part(Part::Overflow | Part::StoredOverflow) => !ranges().overflow(),
            Use::Function("LEN") => lengths_are_stored(self.program),
            Use::Type(_) | Use::Function(_) | Use::Operator(..) | Use::Conversion(..) | Use::Part(_) => false,
        }
    }
}

/// Whether nothing is computed with a length before it is in a variable, so that it does not matter that it has no sign.
fn lengths_are_stored(program: &Program) -> bool {
    let is_length = |it: &Expr| matches!(it.kind, ExprKind::ApplyText(TextOp::Len, _));
    let (mut all, mut stored) = (0, 0);
    for routine in &program.routines {
        visit::statements(&routine.body, &mut |statement| {
            visit::all_exprs(statement, &mut |it| all += usize::from(is_length(it)));
            let StatementKind::Assign { value, .. } = &statement.kind else { return };
            let mut value = value;
            while let ExprKind::Convert(_, inner) = &value.kind {
                value = inner;
            }
            stored += usize::from(is_length(value));
        });
    }
    all == stored
}

/// A sentence for each value that the system's documents leave open, and that the program may come to.
pub fn open(program: &Program, dialect: Dialect, starts: &HashMap<Name, Range>) -> Vec<String> {
    let rows = EDGES.iter().filter(|it| it.dialect == dialect);
    let harmless = Harmless::of(program, starts);
    let found = rows.filter_map(|row| {
        let reached = row.uses.iter().filter(|it| !harmless.has(**it));
        let line = reached.filter_map(|it| used(program, *it)).min()?;
        let (system, what) = (dialect.name().to_ascii_uppercase(), row.what);
        Some(format!(
            "The documents of {system} do not specify {what} (line {line}); Staunch: {} ({}).",
            row.here, row.documented
        ))
    });
    found.collect()
}

fn first_field(place: &Place) -> Option<FieldId> {
    match place.projections.first() {
        Some(Projection::Field(field)) => Some(*field),
        Some(Projection::Index { .. } | Projection::Deref { .. }) | None => None,
    }
}

/// The first call of a FUNCTION_BLOCK, or of a FUNCTION or METHOD, that gives a VAR_IN_OUT what is global, or what it gives another.
fn copied_in_out(program: &Program, wanted: Use) -> Option<u32> {
    let of_block = match wanted {
        Use::Part(Part::InOutCopied) => true,
        Use::Part(Part::InOutOfFunctionCopied) => false,
        _ => return None,
    };
    let mut found: Option<u32> = None;
    for routine in &program.routines {
        visit::statements(&routine.body, &mut |statement| {
            let StatementKind::Call { instance, arguments, .. } = &statement.kind else { return };
            if instance.is_some() != of_block {
                return;
            }
            let given = arguments.iter().filter_map(|it| match it {
                Argument::Reference(place) => Some((place.root, first_field(place))),
                Argument::Value(_) => None,
            });
            let given: Vec<_> = given.collect();
            let is_twice = given.iter().enumerate().any(|(at, it)| given[..at].contains(it));
            if is_twice || given.iter().any(|it| it.0 == Root::Globals) {
                found = Some(found.map_or(statement.at.line, |it| it.min(statement.at.line)));
            }
        });
    }
    found
}

/// The first line that declares a timer, for what a timer does in such scans.
fn timer(program: &Program, wanted: Use) -> Option<u32> {
    let is_timer = |it: &&Field| matches!(it.ty, Type::Block(block) if block.info().pin("ET").is_some());
    let declared = program.structs.iter().flat_map(|it| &it.fields).filter(is_timer).map(|it| it.location.line);
    declared.min().filter(|_| wanted == Use::Part(Part::PartsOfMillisecond))
}

/// The first line that has it: of a type, also one that declares an input of it.
fn used(program: &Program, wanted: Use) -> Option<u32> {
    let is_it = |it: &&Field| match (wanted, it.ty.elementary()) {
        (Use::Type(ty), Some(own)) => it.section == Section::Input && own == ty,
        (Use::Type(_) | Use::Function(_) | Use::Operator(..) | Use::Conversion(..) | Use::Part(_), _) => false,
    };
    let programs = program.instances.iter().map(|it| program.class(it.program).state).chain([program.globals]);
    let inputs = programs.flat_map(|it| &program.structure(it).fields).filter(is_it).map(|it| it.location.line);
    inputs.chain(program.uses.first(wanted).map(|it| it.line)).min()
}

#[cfg(test)]
mod tests {
    use super::{Use, used};
    use staunch_frontend::{Options, Source, Sources, compile};
    use staunch_ir::{Elementary, Program};
    use staunch_runtime::Class;

    const SOURCE: &str = "PROGRAM p
VAR_INPUT x : LREAL; END_VAR
VAR s : STRING; n : INT; w : WORD; r : REAL; t : TIME; b : BOOL; END_VAR
s := LEFT('AB', 1);
n := 2 + 3;
r := 7.0 / 2.0;
w := REAL_TO_WORD(REAL#2.5);
t := T#1s - T#2s;
b := WORD#1 = WORD#2;
b := n > 5 AND 7 <> SINT#2;
END_PROGRAM
";

    fn compiled(source: &str) -> Program {
        let mut sources = Sources::default();
        sources.add(Source::new("uses.st", source.to_owned()));
        let compiled = compile(&sources, &Options::default());
        compiled.program.unwrap_or_else(|| panic!("{:?}", compiled.diagnostics))
    }

    /// Each kind of use is found, also where constants are folded.
    #[test]
    fn each_kind_of_use_is_found() {
        let program = compiled(SOURCE);
        let found = |wanted| used(&program, wanted);
        assert_eq!(found(Use::Function("LEFT")), Some(4));
        assert_eq!(found(Use::Function("RIGHT")), None);
        assert_eq!(found(Use::Operator("+", Class::Int)), Some(5));
        assert_eq!(found(Use::Operator("+", Class::Real)), None);
        assert_eq!(found(Use::Conversion(Class::Real, Class::Bit)), Some(7));
        assert_eq!(found(Use::Conversion(Class::Real, Class::Int)), None);
        assert_eq!(found(Use::Type(Elementary::Time)), Some(8));
        assert_eq!(found(Use::Type(Elementary::Lreal)), Some(2));
        assert_eq!(found(Use::Operator("=", Class::Bit)), Some(9));
        assert_eq!(found(Use::Type(Elementary::Sint)), None);
    }
}

//! The state of checking a body, or a constant expression.

use super::call_tracking::Called;
use super::late_target::LateTarget;
use super::uses::Uses;
use crate::dialect::rules::is_followed;
use crate::spelling::Key;
use crate::testing::suite::WANTED;
use crate::types::counter::Counter;
use crate::types::coverage::Role;
use crate::types::declarations::Declarations;
use crate::types::jumps::Jumps;
use crate::types::scope::Scope;
use crate::types::signature::Signature;
use crate::{Code, Diagnostic, Span, ast};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Block, Elementary, Expr, Local, Location, Part, Place, Statement, StatementKind, Type};
use std::rc::Rc;

/// The result for a call of overloaded FUNCTIONs: it is computed once, however often the call is checked.
pub(crate) type Choice = Result<usize, Box<Diagnostic>>;

/// Checks the body of one POU, or one constant expression.
pub(crate) struct Checker<'d, 's> {
    pub decl: &'d mut Declarations<'s>,
    pub scope: Rc<Scope<'s>>,
    /// Of the POU whose body this is.
    pub slot: Option<usize>,
    /// Of the POU whose body this is; a constant expression has none.
    pub signature: Option<Rc<Signature<'s>>>,
    /// The slot, where that is an instance of a generic FUNCTION, or such a FUNCTION itself.
    pub instance: Option<usize>,
    /// The statements made so far for the innermost list; hoisted calls go to its end.
    pub block: Block,
    /// The dialect's system does the calls of an expression in another order.
    pub is_reordered: bool,
    /// Where in the block the statement began, if it is.
    pub statement_from: Option<usize>,
    pub locals: Vec<Local>,
    /// The FOR loops around the statement.
    pub counters: Vec<Counter>,
    /// How many loops are around the statement.
    pub loops: usize,
    /// The lists with labels around the statement.
    pub jumps: Vec<Jumps<'s>>,
    pub known_labels: FxHashSet<Key<'s>>,
    pub uses: Uses,
    pub context: Context,
    /// Instances called so far on the way to this statement.
    pub called: Called,
    /// The calls of which one takes back what the other gives, which are reported as such.
    pub dead_calls: FxHashSet<Span>,
    /// Which of the overloaded FUNCTIONs calls mean, by the places of these names.
    pub choices: FxHashMap<(Span, Option<Elementary>), Choice>,
    /// The first statement that makes nothing, because something in it was refused.
    pub left_out: Option<Span>,
    /// What is checked may never be evaluated, as a call whose EN is FALSE: a constant that faults there is not a mistake.
    pub may_not_run: bool,
    /// Where an ENO of the innermost call with one leads, while the call's arguments are evaluated.
    pub late: Option<LateTarget<'s>>,
    /// What is executed of the body is counted.
    pub is_covered: bool,
    /// A run can stop before its statements.
    pub has_stops: bool,
    /// Where the BOOLs are written that are counted, by what they have of that in the IR.
    pub written: FxHashMap<(Location, Role), Span>,
    /// The structure whose members' declarations are followed: THIS means it there.
    pub this_structure: Option<Place>,
    /// What an assertion of a suite compares: the globals that keep it if the assertion fails.
    pub compared: Vec<(Place, Expr)>,
}

/// What a name of a variable stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Context {
    /// Its storage.
    Body,
    /// Nothing: a constant is wanted.
    Constant,
    /// Its initial value: another variable's initial value may use it.
    Initial,
}

impl<'d, 's> Checker<'d, 's> {
    /// For the body with a signature.
    pub fn of_body(decl: &'d mut Declarations<'s>, slot: usize, signature: &Rc<Signature<'s>>) -> Self {
        let mut checker = Self::new(decl, &signature.scope, Context::Body);
        checker.slot = Some(slot);
        let dialect = checker.decl.dialect(checker.decl.pous[slot].ast.name.span);
        checker.is_reordered = !is_followed(dialect, Part::EvaluationOrder);
        checker.locals.clone_from(&signature.locals);
        checker.signature = Some(Rc::clone(signature));
        checker
    }

    pub fn new(decl: &'d mut Declarations<'s>, scope: &Rc<Scope<'s>>, context: Context) -> Self {
        Self {
            decl,
            scope: Rc::clone(scope),
            slot: None,
            signature: None,
            instance: None,
            block: Vec::new(),
            is_reordered: false,
            statement_from: None,
            locals: Vec::new(),
            counters: Vec::new(),
            loops: 0,
            jumps: Vec::new(),
            known_labels: FxHashSet::default(),
            uses: Uses::default(),
            context,
            called: Called::default(),
            dead_calls: FxHashSet::default(),
            choices: FxHashMap::default(),
            left_out: None,
            may_not_run: false,
            late: None,
            is_covered: false,
            has_stops: false,
            written: FxHashMap::default(),
            this_structure: None,
            compared: Vec::new(),
        }
    }

    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.decl.report(diagnostic);
    }

    pub fn error(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.decl.error(code, span, message);
    }

    pub(crate) fn is_test(&self) -> bool {
        self.test_slot().is_some()
    }

    /// Whether the body is one of a TcUnit suite.
    pub(crate) fn is_suite(&self) -> bool {
        self.scope.get(WANTED).is_some()
    }

    /// Whether the body is one of a unit test, whatever its kind: it takes the place of a program's surroundings.
    pub(crate) fn is_of_tests(&self) -> bool {
        self.is_test() || self.is_suite() || self.slot.is_some_and(|it| self.decl.is_of_fixture(it))
    }

    /// Whether the body is that of a run in a CONFIGURATION.
    pub(crate) fn is_run(&self) -> bool {
        self.slot.is_some_and(|it| self.decl.pous[it].run.is_some())
    }

    /// The slot of the TEST whose body this is.
    pub(crate) fn test_slot(&self) -> Option<usize> {
        let slot = self.decl.slot_of_instance(self.signature.as_ref()?.state?)?;
        (self.decl.pous[slot].ast.kind == ast::PouKind::Test).then_some(slot)
    }

    pub fn is_function_block(&self) -> bool {
        let slot = self.signature.as_ref().and_then(|it| it.state).and_then(|it| self.decl.slot_of_instance(it));
        slot.is_some_and(|slot| self.decl.pous[slot].ast.kind.is_block())
    }

    pub fn at(&mut self, span: Span) -> Location {
        self.decl.location(span)
    }

    pub fn type_name(&self, ty: Type) -> String {
        self.decl.program.type_name(ty)
    }

    pub fn push(&mut self, kind: StatementKind, span: Span) {
        let statement = Statement::new(kind, self.at(span));
        self.count_values_of(&statement);
        self.block.push(statement);
    }

    pub fn assign(&mut self, target: Place, value: Expr, span: Span) {
        self.push(StatementKind::Assign { target, value }, span);
    }

    /// The statements that `make` adds, as a list of their own.
    pub fn nested(&mut self, make: impl FnOnce(&mut Self)) -> Block {
        let outer = std::mem::take(&mut self.block);
        let from = self.statement_from.replace(0);
        self.statement_from = from.and(self.statement_from);
        make(self);
        let mut made = std::mem::replace(&mut self.block, outer);
        self.statement_from = from;
        // Most blocks are small, and live as long as the program.
        made.shrink_to_fit();
        made
    }
}

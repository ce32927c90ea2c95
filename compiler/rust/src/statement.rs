//! Statements, each after a mark of its source line (`format` turns marks into comments).

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use staunch_ir::{
    Argument, Arm, Block, Expr, ExprKind, Location, Place, Repr, Root, RoutineId, RoutineKind, Statement,
    StatementKind, Type,
};

use crate::function::Function;
use crate::literal::{literal, plain};
use crate::names::ident;
use crate::precedence::Level;
use crate::short_circuit::Folded;
use staunch_ir::faults;

impl Function<'_> {
    pub fn block(&mut self, block: &Block) -> TokenStream {
        self.statements(block)
    }

    pub fn statements(&mut self, statements: &[Statement]) -> TokenStream {
        let mut printed = TokenStream::new();
        let mut rest = statements;
        while let [statement, after @ ..] = rest {
            let all = rest;
            rest = after;
            printed.extend(self.mark(statement.at));
            if let Some(folded) = self.fold(all) {
                rest = folded.after;
                printed.extend(self.reader(&folded));
            } else if let Some((joined, then)) = self.joined(statement, after) {
                rest = then;
                printed.extend(joined);
            } else {
                printed.extend(self.statement(statement));
            }
        }
        printed
    }

    fn mark(&mut self, at: Location) -> Option<TokenStream> {
        let line = Some((at.file, at.line));
        if line == self.marked || at.line == 0 {
            return None;
        }
        self.marked = line;
        let text =
            if at.file == self.routine.location.file { format!(":{}", at.line) } else { self.emitter.source(at) };
        Some(quote!(st_mark!(#text);))
    }

    /// `x = f(…);` for a call whose result only the assignment after it reads.
    fn joined<'s>(&self, statement: &Statement, after: &'s [Statement]) -> Option<(TokenStream, &'s [Statement])> {
        let StatementKind::Call { result: Some(result), .. } = &statement.kind else { return None };
        let (next, then) = after.split_first()?;
        let StatementKind::Assign { target, value } = &next.kind else { return None };
        let (Root::Local(id), ExprKind::Load(place)) = (result.root, &value.kind) else { return None };
        let only = place.root == result.root
            && place.projections.is_empty()
            && result.projections.is_empty()
            && self.plan.locals[id.index()].mentions == 2
            && self.routine.result != Some(id);
        if !only {
            return None;
        }
        let call = self.call(statement);
        Some((self.assigned(next, target, call), then))
    }

    fn statement(&mut self, statement: &Statement) -> TokenStream {
        match &statement.kind {
            StatementKind::Assign { target, value } => self.assign(statement, target, value),
            StatementKind::If { condition, then, otherwise } => self.if_else(condition, then, otherwise),
            StatementKind::Case { selector, arms, otherwise } => self.case(selector, arms, otherwise),
            StatementKind::Loop { body, continuing, count } => self.repeat(body, continuing, count.as_deref()),
            StatementKind::For(it) => self.for_loop(statement, it),
            StatementKind::Turn => {
                let at = self.emitter.at(statement.at);
                let take = quote!(cx.take_turn()#at?;);
                self.loops.few.as_ref().map_or_else(|| take.clone(), |few| quote!(if !#few { #take }))
            }
            StatementKind::Try { body, kind, handler } => self.attempt(statement, body, kind, handler),
            StatementKind::Finally { body, last } => self.finally(body, last),
            StatementKind::Exit => self.leave(),
            StatementKind::Continue => self.next(),
            StatementKind::Return => self.return_from_body(),
            StatementKind::Call { result: Some(result), .. } => {
                let call = self.call(statement);
                self.assigned(statement, result, call)
            }
            StatementKind::Call { result: None, .. } => {
                let call = self.call(statement);
                quote!(#call;)
            }
            StatementKind::External(it) => self.external(statement, it),
            StatementKind::CallBlock { block, instruction, inputs } => self.call_block(block, *instruction, inputs),
            StatementKind::PrescanBlock { block, instruction } => self.prescan_block(block, *instruction),
            StatementKind::Stop(_) => TokenStream::new(),
            StatementKind::Fault(kind) => {
                let (kind, at) = (format_ident!("{kind:?}"), self.emitter.at(statement.at));
                quote!(return Err(FaultKind::#kind)#at;)
            }
        }
    }

    fn assign(&mut self, statement: &Statement, target: &Place, value: &Expr) -> TokenStream {
        if self.emitter.shared && !self.is_simple_target(target) {
            return self.assign_shared(statement, target, value);
        }
        if let Some(written) = self.assign_text(statement, target, value) {
            return written;
        }
        let printed = self.expr(value).tokens;
        // Rust evaluates the value before the target's subscripts; the first fault wins here.
        if self.place_faults(target) && faults::expr_faults(self.emitter.program, value) {
            let mut before = Vec::new();
            let place = self.fixed_place(target, &mut before);
            return quote!(#(#before)* #place = #printed;);
        }
        self.assigned(statement, target, printed)
    }

    /// Whether finding the target cannot fault before its value does.
    fn is_simple_target(&self, target: &Place) -> bool {
        !self.place_faults(target)
    }

    /// As `assign`, where storage is shared: the target's indices and reference come first.
    fn assign_shared(&mut self, statement: &Statement, target: &Place, value: &Expr) -> TokenStream {
        let printed = self.expr(value).tokens;
        if target.is_followed() || self.is_pin(target) {
            return self.assigned(statement, target, printed);
        }
        // The arguments of a method call follow what it is called on.
        let place = self.written_place(target);
        if self.is_cell(target) {
            return quote!(#place.set(#printed););
        }
        quote!(reference::Shared::assign(&#place, &#printed);)
    }

    /// `target = value;`, which may declare the target.
    pub fn assigned(&self, statement: &Statement, target: &Place, value: TokenStream) -> TokenStream {
        if let Some(local) = self.plan.declares(statement, target) {
            let left = self.let_local(local);
            let value = if self.borrowed_scalar(local) { quote!(Cell::new(#value)) } else { value };
            return quote!(#left = #value;);
        }
        if self.emitter.shared {
            return self.set(target, &value);
        }
        let target = self.target(target, self.written_place(target));
        quote!(#target = #value;)
    }

    fn if_else(&mut self, condition: &Expr, then: &Block, otherwise: &Block) -> TokenStream {
        let condition = self.expr(condition).tokens;
        self.if_so(&condition, then, otherwise)
    }

    pub fn if_so(&mut self, condition: &TokenStream, then: &Block, otherwise: &Block) -> TokenStream {
        let then = self.block(then);
        let otherwise = match otherwise.as_slice() {
            [] => None,
            [Statement { kind: StatementKind::If { condition, then, otherwise }, .. }] => {
                let chained = self.if_else(condition, then, otherwise);
                Some(quote!(else #chained))
            }
            otherwise => match self.fold(otherwise).filter(Folded::is_all_and_an_if) {
                Some(it) => {
                    let chained = self.reader(&it);
                    Some(quote!(else #chained))
                }
                None => {
                    let otherwise = self.statements(otherwise);
                    Some(quote!(else { #otherwise }))
                }
            },
        };
        quote!(if #condition { #then } #otherwise)
    }

    fn case(&mut self, selector: &Expr, arms: &[Arm], otherwise: &Block) -> TokenStream {
        let repr = self.repr(selector.ty);
        let named = match selector.ty {
            Type::Enum(_) => arms.iter().flat_map(|arm| &arm.labels).all(|(first, last)| first == last),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => false,
        };
        let labelled = if named { Some(selector.ty) } else { None };
        let on = if let (Type::Enum(_), false) = (selector.ty, named) {
            let selector = self.typed(selector).at_least(Level::Postfix);
            quote!(#selector.0)
        } else {
            self.typed(selector).tokens
        };
        if arms.is_empty() {
            let otherwise = self.block(otherwise);
            return quote!(let _ = #on; #otherwise);
        }
        if let [Arm { labels, body }] = arms {
            let pattern = self.pattern(labels, repr, labelled);
            let condition = match labels.as_slice() {
                [(first, last)] if first == last => quote!(#on == #pattern),
                _ => quote!(matches!(#on, #pattern)),
            };
            let body = self.block(body);
            let otherwise = (!otherwise.is_empty()).then(|| {
                let otherwise = self.block(otherwise);
                quote!(else { #otherwise })
            });
            return quote!(if #condition { #body } #otherwise);
        }
        let mut printed = Vec::with_capacity(arms.len());
        for arm in arms {
            let (pattern, body) = (self.pattern(&arm.labels, repr, labelled), self.block(&arm.body));
            printed.push(quote!(#pattern => { #body }));
        }
        let rest = (named || !covers(arms, repr)).then(|| {
            let otherwise = self.block(otherwise);
            quote!(_ => { #otherwise })
        });
        quote!(match #on { #(#printed)* #rest })
    }

    /// Labels as a pattern; by name if the selector is of an enumeration.
    fn pattern(&self, labels: &[(i128, i128)], repr: Repr, named: Option<Type>) -> TokenStream {
        let value = |number: i128| -> TokenStream {
            let value = repr.integer(number).expect("verified IR: a label fits its selector");
            match named {
                Some(Type::Enum(id)) => self.emitter.enum_value(id, value).tokens,
                Some(_) | None => literal(plain(repr), value, false).tokens,
            }
        };
        let labels = labels.iter().map(|(first, last)| {
            let (low, high) = (value(*first), value(*last));
            if first == last { low } else { quote!(#low..=#high) }
        });
        quote!(#(#labels)|*)
    }

    /// A call of a routine, as an expression.
    fn call(&self, call: &Statement) -> TokenStream {
        let StatementKind::Call { callee, instance, arguments, .. } = &call.kind else {
            unreachable!("only calls are printed as calls")
        };
        let needs = &self.emitter.effects[callee.index()];
        let is_scan = self.emitter.program.routine(*callee).kind == RoutineKind::Body;
        let context = (needs.context || is_scan).then(|| quote!(cx));
        let globals = self.emitter.world_argument(needs);
        let arguments = arguments.iter().map(|it| self.argument(it));
        let all = context.into_iter().chain(arguments).chain(globals);
        let head = self.call_head(*callee, instance.as_ref());
        let propagate = (needs.faults || is_scan).then(|| quote!(?));
        let at = needs.faults_at_call.then(|| self.emitter.at(call.at));
        quote!(#head(#(#all),*) #at #propagate)
    }

    fn call_head(&self, callee: RoutineId, instance: Option<&Place>) -> TokenStream {
        let name = self.emitter.names.routine(callee);
        match instance {
            Some(place) => {
                let place = self.place(place);
                quote!(#place.#name)
            }
            None => quote!(#name),
        }
    }

    pub fn argument(&self, argument: &Argument) -> TokenStream {
        match argument {
            Argument::Value(value) => self.expr(value).tokens,
            Argument::Reference(place) => self.borrowed(place),
        }
    }

    fn call_block(&self, block: &Place, instruction: usize, inputs: &[Expr]) -> TokenStream {
        let info = &block_of(block).instructions[instruction];
        let (place, method) = (self.place(block), ident(info.method));
        let inputs = inputs.iter().map(|it| self.expr(it).tokens);
        let context = info.needs_context.then(|| quote!(cx));
        let arguments = inputs.chain(context);
        if self.emitter.shared {
            let cell = self.borrowed(block);
            return quote!({ let cell = #cell; let mut block = cell.get(); block.#method(#(#arguments),*); cell.set(block); });
        }
        quote!(#place.#method(#(#arguments),*);)
    }

    fn prescan_block(&self, block: &Place, instruction: usize) -> TokenStream {
        let Some(prescan) = &block_of(block).instructions[instruction].prescan else { return TokenStream::new() };
        let (place, method) = (self.place(block), ident(prescan.method));
        if self.emitter.shared {
            return quote!({ let mut block = #place.get(); block.#method(); #place.set(block); });
        }
        quote!(#place.#method();)
    }
}

fn block_of(place: &Place) -> &'static staunch_runtime::BlockInfo {
    let Type::Block(id) = place.ty else { unreachable!("verified IR: a block is called") };
    id.info()
}

/// Whether the labels leave no value over.
fn covers(arms: &[Arm], repr: Repr) -> bool {
    let Some((least, greatest)) = repr.range() else { return false };
    let held: i128 = arms.iter().flat_map(|arm| &arm.labels).map(|(first, last)| last - first + 1).sum();
    held == greatest - least + 1
}

//! W0507: an instance that is called again on the way to a statement. It sees an edge twice, or none, unless the
//! second call is one that starts it anew.

use super::call_tracking::Call;
use super::checker::Checker;
use super::migration::bare;
use crate::spelling::Key;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, ExprKind as Ast, LiteralValue};
use staunch_ir::{BlockId, Place, Type};
use staunch_runtime::PinRole;

/// Blocks of TwinCAT's that know nothing of earlier calls.
const AT_ONCE: [&str; 4] = ["FB_FormatString", "FB_FormatString2", "GETCURTASKINDEX", "GETCPUCOUNTER"];

impl<'s> Checker<'_, 's> {
    /// A counter or timer that is called twice in a scan sees two edges, or none.
    pub(super) fn note_called(&mut self, place: &Place, arguments: &[ast::Argument<'s>], callee: &ast::Expr<'s>) {
        // A test calls again and again, and says itself when time passes.
        if self.is_of_tests() || is_latch(place.ty) || self.is_at_once(place.ty) {
            return;
        }
        if only_resets(place.ty, arguments) {
            if is_timer(place.ty) {
                self.called.take_back(place);
            }
            return;
        }
        if self.is_asked(place.ty, callee) || self.resets_with_the_same_inputs(place, arguments) {
            return;
        }
        let counted = counted(place.ty, arguments);
        if let Some(first) = self.called.note(place, Call { span: callee.span, counted })
            && !self.dead_calls.contains(&callee.span)
        {
            let text = self.decl.log.sources.text(callee.span).to_owned();
            let error = Diagnostic::new(Code::W0507, callee.span, format!("`{text}` is called twice in a scan"))
                .label("called again here")
                .other(first.span, "first called here")
                .help("declare a second instance, or call it once and use its outputs");
            self.report(error);
        }
    }

    /// Whether it is a block of the library that does all of its work in each call.
    fn is_at_once(&self, ty: Type) -> bool {
        let slot = if let Type::Struct(id) = ty { self.decl.slot_of_instance(id) } else { None };
        let name = slot.map(|it| self.decl.pous[it].ast.name.text);
        name.is_some_and(|name| AT_ONCE.iter().any(|it| Key(it) == Key(name)))
    }

    /// Notes the members that a condition reads, of whatever has such: its branch may start the instance anew.
    pub(crate) fn note_asked(&mut self, condition: &ast::Expr<'s>) {
        let (sources, asked) = (&self.decl.log.sources, &mut self.called.asked);
        ast::each_part(condition, &mut |it| {
            if let Ast::Member(base, member) = &it.kind {
                asked.push((sources.text(base.span).to_ascii_uppercase(), member.text.to_ascii_uppercase()));
            }
        });
    }

    /// Whether an IF around the call asks an output of the instance: what expired or is done is started anew.
    /// A counter or trigger is not, by a call that makes an edge.
    fn is_asked(&self, ty: Type, callee: &ast::Expr<'s>) -> bool {
        let restarts = match ty {
            Type::Block(_) => is_timer(ty),
            Type::Struct(_) => true,
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_) => false,
        };
        let text = self.decl.log.sources.text(callee.span).to_ascii_uppercase();
        let is_input = |member: &str| is_timer(ty) && matches!(member, "IN" | "PT");
        restarts && self.called.asked.iter().any(|(base, member)| *base == text && !is_input(member))
    }

    /// `c(CU := sensor, R := TRUE, …)` after `c(CU := sensor, R := FALSE, …)`: no edge is seen that was not there.
    fn resets_with_the_same_inputs(&self, place: &Place, arguments: &[ast::Argument<'s>]) -> bool {
        let Some(first) = self.called.first(place) else { return false };
        let text = |span: Span| self.decl.log.sources.text(span).to_ascii_uppercase();
        let inputs = counted(place.ty, arguments).into_iter().zip(first.counted);
        let mut is_same =
            inputs.map(|(now, first)| now.is_none_or(|now| first.is_some_and(|it| text(it) == text(now))));
        resets_surely(place.ty, arguments) && is_same.all(|it| it)
    }
}

/// What a call gives for the inputs that count up and down.
fn counted(ty: Type, arguments: &[ast::Argument<'_>]) -> [Option<Span>; 2] {
    [PinRole::Up, PinRole::Down].map(|it| input(ty, arguments, it).map(|it| it.span))
}

/// The value given for an input of a block, by its name or its position.
pub(super) fn input<'a, 's>(ty: Type, arguments: &'a [ast::Argument<'s>], role: PinRole) -> Option<&'a ast::Expr<'s>> {
    let Type::Block(block) = ty else { return None };
    let position = block.info().inputs().position(|it| it.role == Some(role))?;
    let named = arguments.iter().find_map(|it| match &it.kind {
        ArgumentKind::Input(name, value) if role_of(block, name.text) == Some(role) => Some(value),
        ArgumentKind::Input(..) | ArgumentKind::Positional(_) | ArgumentKind::Output { .. } => None,
    });
    named.or_else(|| match &arguments.get(position)?.kind {
        ArgumentKind::Positional(value) => Some(value),
        ArgumentKind::Input(..) | ArgumentKind::Output { .. } => None,
    })
}

/// Whether a call resets or loads a counter, whatever variables hold.
pub(super) fn resets_surely(ty: Type, arguments: &[ast::Argument<'_>]) -> bool {
    [PinRole::Reset, PinRole::Load].into_iter().any(|it| input(ty, arguments, it).is_some_and(|it| is_bool(it, true)))
}

/// Whether a call does no more than reset or load a counter, or take back a timer's input: it comes in addition to
/// the one that counts.
pub(super) fn only_resets(ty: Type, arguments: &[ast::Argument<'_>]) -> bool {
    let is_timer = is_timer(ty);
    let resets = |it: &ast::Argument<'_>| match &it.kind {
        ArgumentKind::Input(name, value) if name.text.eq_ignore_ascii_case("IN") => is_timer && is_bool(value, false),
        ArgumentKind::Input(name, _) if name.text.eq_ignore_ascii_case("PT") => is_timer,
        ArgumentKind::Input(name, _) => {
            matches!(role_of_named(ty, name.text), Some(PinRole::Reset | PinRole::Load))
        }
        ArgumentKind::Positional(_) | ArgumentKind::Output { .. } => false,
    };
    let names_in = |it: &ast::Argument<'_>| matches!(&it.kind, ArgumentKind::Input(name, _) if !name.text.eq_ignore_ascii_case("PT"));
    arguments.iter().any(names_in) && arguments.iter().all(resets)
}

/// The role of what a call names: of a pin of the block, or of one that another system's block has.
fn role_of(block: BlockId, name: &str) -> Option<PinRole> {
    match block.info().pin(name) {
        Some(pin) => pin.role,
        None => PinRole::named(name),
    }
}

fn role_of_named(ty: Type, name: &str) -> Option<PinRole> {
    if let Type::Block(block) = ty { role_of(block, name) } else { PinRole::named(name) }
}

fn is_bool(expr: &ast::Expr<'_>, wanted: bool) -> bool {
    match bare(expr).kind {
        Ast::Literal(ast::Literal { value: LiteralValue::Bool(value), .. }) => value == wanted,
        _ => false,
    }
}

fn is_timer(ty: Type) -> bool {
    matches!(ty, Type::Block(id) if id.info().pin("PT").is_some())
}

/// A latch has no edge and no time: each call is a call.
fn is_latch(ty: Type) -> bool {
    matches!(ty, Type::Block(id) if id.info().pin_for(PinRole::Set).is_some() && id.info().pin_for(PinRole::Count).is_none())
}

//! A call of an instance that is not declared: the block that has the pins of the call is probably its type.

use super::checker::Checker;
use crate::dialect::bare_block;
use crate::spelling::Key;
use crate::{Diagnostic, ast};
use ast::{ArgumentKind, VarKind};
use staunch_runtime::{BLOCKS, BlockInfo, Direction};

impl<'s> Checker<'_, 's> {
    /// How to declare what is called with these arguments.
    pub(super) fn help_on_instance(
        &self,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        error: &Diagnostic,
    ) -> Option<Diagnostic> {
        let ty = self.block_with_pins(name, arguments);
        let in_quotes = self.name_in_quotes(name);
        let is_function = arguments.iter().any(|it| matches!(it.kind, ArgumentKind::Positional(_)));
        if let Some(text) = in_quotes.filter(|_| is_function) {
            let help = format!("add the source of the block: `FUNCTION \"{text}\" … END_FUNCTION`");
            return Some(error.clone().label("no block of the project has this name").help(help));
        }
        let help = match (ty, in_quotes) {
            (Some((ty, true)), Some(text)) => {
                format!("declare its instance data block: `DATA_BLOCK \"{text}\" \"{ty}\" BEGIN END_DATA_BLOCK`")
            }
            (Some((ty, false)), Some(text)) => {
                format!("declare its instance data block: `DATA_BLOCK \"{text}\" {ty} BEGIN END_DATA_BLOCK`")
            }
            (None, Some(text)) => format!(
                "add its instance data block: `DATA_BLOCK \"{text}\" \"Block\" BEGIN END_DATA_BLOCK`, where `Block` is the FUNCTION_BLOCK \
                 that it is an instance of"
            ),
            (Some((ty, _)), None) => format!("declare the instance: `VAR {} : {ty}; END_VAR`", name.text),
            (None, None) => return None,
        };
        let error = error.clone();
        Some(if in_quotes.is_some() { error.label("no data block has this name") } else { error }.help(help))
    }

    /// The block with the fewest pins that has all that a call names, and whether it is the program's own.
    fn block_with_pins(&self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>]) -> Option<(&str, bool)> {
        let mut pins = Vec::with_capacity(arguments.len());
        for argument in arguments {
            pins.push(match &argument.kind {
                ArgumentKind::Input(pin, _) | ArgumentKind::Output { name: pin, .. } => pin.text,
                ArgumentKind::Positional(_) => return None,
            });
        }
        if pins.is_empty() {
            return None;
        }
        let own = self.decl.pous.iter().filter(|it| it.ast.kind == ast::PouKind::FunctionBlock);
        let own = own.filter_map(|it| {
            let declared = pins_of(it.ast);
            let has_all = pins.iter().all(|pin| declared.iter().any(|it| Key(it) == Key(pin)));
            has_all.then_some((declared.len(), it.ast.name.text))
        });
        if let Some((_, ty)) = own.min_by_key(|it| it.0) {
            return Some((ty, true));
        }
        let dialect = self.decl.dialect(name.span);
        let is_scl = self.name_in_quotes(name).is_some();
        let is_bare = |it: &BlockInfo| bare_block(dialect, it.name).is_some_and(|id| id.info().family == it.family);
        let has = |it: &BlockInfo, pin: &str| it.pin(pin).is_some_and(|it| it.direction != Direction::Memory);
        let blocks = BLOCKS.iter().filter(|it| !it.name.starts_with("__") && it.facts.option.is_none());
        let found = blocks.filter(|it| is_bare(it) && pins.iter().all(|pin| has(it, pin)));
        found
            .min_by_key(|it| it.pins.iter().filter(|pin| pin.direction != Direction::Memory).count())
            .map(|it| (it.facts.alias.filter(|_| is_scl).unwrap_or(it.name), false))
    }
}

fn pins_of<'s>(block: &ast::Pou<'s>) -> Vec<&'s str> {
    let sections =
        block.blocks.iter().filter(|it| matches!(it.kind, VarKind::Input | VarKind::Output | VarKind::InOut));
    sections.flat_map(|it| &it.vars).flat_map(|it| &it.names).map(|it| it.text).collect()
}

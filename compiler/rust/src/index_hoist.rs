//! Subscripts that a loop finds once: its counter as an index, where the loop's bounds keep it
//! within the array's.

use std::collections::BTreeMap;

use proc_macro2::{Ident, TokenStream};
use quote::quote;
use staunch_ir::loops::Known;
use staunch_ir::{ArrayId, Conversion, Expr, ExprKind, For, Location, Place, Projection, Type};

use crate::function::Function;
use crate::loop_state::HoistedIndex;
use staunch_ir::visit;

/// Where a counter is as an index of arrays of one kind of bounds.
struct Use {
    index: Expr,
    array: ArrayId,
    at: Location,
    times: usize,
}

impl Function<'_> {
    /// The subscript found before, if `index` is a counter.
    pub fn subscript(&self, index: &Expr, array: ArrayId) -> Option<&HoistedIndex> {
        let place = counter(index)?;
        let array = self.emitter.program.array(array);
        let is_it =
            |it: &&HoistedIndex| (it.low, it.high) == (array.low, array.high) && it.counter.is_same_variable(place);
        self.hoisted_indices.iter().rev().find(is_it)
    }

    /// The statements at the start of a turn that find the subscripts which its body needs more
    /// than once. They cannot fault: the loop's bounds are known to lie within the arrays'.
    pub fn find_subscripts(&mut self, counted: &For) -> TokenStream {
        let mut found = TokenStream::new();
        for ((low, high), it) in self.uses(counted).into_iter().filter(|(_, it)| it.times > 1) {
            let position = self.position(&it.index, Type::Array(it.array), it.at);
            let name = self.subscript_name(&counted.counter, low, high);
            found.extend(quote!(let #name = #position;));
            self.hoisted_indices.push(HoistedIndex { counter: counted.counter.clone(), low, high, name });
        }
        found
    }

    fn uses(&self, counted: &For) -> BTreeMap<(i64, i64), Use> {
        let mut uses = BTreeMap::new();
        visit::statements(&counted.body, &mut |statement| {
            visit::accesses(statement, &mut |place, _| self.uses_in(place, counted, &mut uses));
        });
        uses
    }

    fn uses_in(&self, place: &Place, counted: &For, uses: &mut BTreeMap<(i64, i64), Use>) {
        let program = self.emitter.program;
        for (projection, ty) in place.projections.iter().zip(self.emitter.types_along(self.routine, place)) {
            let (Projection::Index { index, at }, Type::Array(array)) = (projection, ty) else { continue };
            let is_counter = counter(index).is_some_and(|it| it.is_same_variable(&counted.counter));
            if is_counter
                && (Known { program, loops: &[counted], checked: &|_| false, seen: &[] }).is_within(index, array)
            {
                let bounds = program.array(array);
                let new = || Use { index: (**index).clone(), array, at: *at, times: 0 };
                uses.entry((bounds.low, bounds.high)).or_insert_with(new).times += 1;
            }
        }
    }

    /// Loops one after the other use one name for one thing.
    fn subscript_name(&mut self, counter: &Place, low: i64, high: i64) -> Ident {
        let counter = self.written_place(counter);
        let key = format!("{counter} {low} {high}");
        if let Some(known) = self.counter_names.get(&key) {
            return known.clone();
        }
        let own = counter.into_iter().last().map(|it| it.to_string()).unwrap_or_default();
        let name = self.names.scope.claim(&format!("{}_index", own.trim_start_matches("r#")));
        self.counter_names.insert(key, name.clone());
        name
    }
}

/// The variable that an index is, when it is nothing else.
fn counter(index: &Expr) -> Option<&Place> {
    match &index.kind {
        ExprKind::Load(place) => Some(place),
        ExprKind::Convert(Conversion::Value | Conversion::Same, inner) => match &inner.kind {
            ExprKind::Load(place) => Some(place),
            _ => None,
        },
        _ => None,
    }
}

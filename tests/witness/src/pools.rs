//! Objects that `__NEW` makes and `__DELETE` gives back: each is in a place of its type's pool, of which the first free one
//! is taken.

use crate::constants::path;
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::starts::Assigns;
use crate::storage::{Cell, Place, Value};
use crate::types::{RefKind, Reference, Slot, Type};
use staunch_frontend::Span;
use staunch_frontend::ast::{Argument, Expr, ExprKind, Item, PouKind};
use staunch_runtime::FaultKind;

/// A place for an object.
#[derive(Clone, Debug)]
pub(crate) struct Berth<'a> {
    place: Place<'a>,
    slot: Slot<'a>,
    is_taken: bool,
}

impl<'a> Machine<'a> {
    pub(crate) fn start_pools(&mut self) -> Outcome<()> {
        let files = self.declared.files;
        let mut pools: Vec<(Slot<'a>, u32)> = Vec::new();
        let mut pous = 0;
        for item in files.iter().flat_map(|it| &it.items) {
            match item {
                Item::Pou(pou) => {
                    let count = pou.pool.and_then(|it| it.count).filter(|_| pou.kind != PouKind::Interface);
                    if let Some(count) = count {
                        pools.push((Slot::of(self.declared.instance_of(pous)?), count));
                    }
                    pous += 1;
                }
                Item::Types(types) => {
                    for declared in types {
                        if let Some(count) = declared.pool.and_then(|it| it.count) {
                            pools.push((self.declared.declared(declared)?, count));
                        }
                    }
                }
                Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => {}
            }
        }
        for (slot, count) in pools {
            for _ in 0..count {
                let place = self.allocate(&slot.ty);
                self.start(&Frame::default(), &place, slot.initial)?;
                self.pool.push(Berth { place, slot: slot.clone(), is_taken: false });
            }
        }
        Ok(())
    }

    /// `__NEW(Job(more := 5))`: where no place is free, no argument is evaluated.
    pub(crate) fn make(&mut self, frame: &Frame<'a>, what: &'a Expr<'a>) -> Outcome<Value<'a>> {
        let (name, arguments): (_, &'a [Argument<'a>]) = match &what.kind {
            ExprKind::Call(name, arguments) => (&**name, arguments),
            _ => (what, &[]),
        };
        let Some(path) = path(name) else { return unknown("what __NEW makes") };
        let ty = self.declared.named(&path)?.ty;
        let free = self.pool.iter().position(|it| !it.is_taken && same(&it.slot.ty, &ty));
        let pointer = Type::Reference(Reference { kind: RefKind::Pointer, target: None });
        let Some(free) = free else { return Ok(Value { ty: pointer, cells: vec![Cell::Reference(None)] }) };
        self.pool[free].is_taken = true;
        let Berth { place, slot, .. } = self.pool[free].clone();
        let before = std::mem::replace(&mut self.assigns, Assigns::VALUES);
        let started = self.start(&Frame::default(), &place, slot.initial);
        self.assigns = before;
        started?;
        match place.ty.class() {
            Some(class) => self.construct_instance(frame, &place, class, arguments)?,
            None => self.construct(&Frame::default(), &place, &slot)?,
        }
        self.call_after_init(&place)?;
        Ok(Value { ty: pointer, cells: vec![Cell::Reference(Some(Box::new(place)))] })
    }

    /// `__DELETE(p)`: FB_exit of an heir before its base's, then the place is free, and `p` null.
    pub(crate) fn delete(&mut self, frame: &Frame<'a>, pointer: &'a Expr<'a>, span: Span) -> Outcome<()> {
        let target = self.unfollowed(frame, pointer)?;
        let target = self.checked(target)?;
        let object = match &self.memory[target.at] {
            Cell::Reference(Some(object)) => (**object).clone(),
            Cell::Reference(None) => return Ok(()),
            Cell::Scalar(_) | Cell::Text(_) | Cell::Bytes(_) => {
                return unknown("__DELETE of something other than a reference");
            }
        };
        let Some(berth) = self.pool.iter().position(|it| it.place.at == object.at) else {
            return Err(self.fault(FaultKind::NotOfPool, span));
        };
        if !self.pool[berth].is_taken {
            return Err(self.fault(FaultKind::Deleted, span));
        }
        let place = self.pool[berth].place.clone();
        let mut line = place.ty.class().map_or_else(Vec::new, |it| self.declared.line_down(it));
        line.reverse();
        for class in line {
            if let Some(exit) = self.declared.own_routine(class, "FB_exit") {
                self.run_routine(&Frame::default(), exit, &place, Vec::new())?;
            }
        }
        self.pool[berth].is_taken = false;
        self.memory[target.at] = Cell::Reference(None);
        Ok(())
    }

    /// Whether a place is in an object that was deleted.
    pub(crate) fn is_deleted(&self, place: &Place<'a>) -> bool {
        let holds = |it: &Berth<'a>| (it.place.at..it.place.at + it.place.ty.size()).contains(&place.at);
        self.pool.iter().any(|it| !it.is_taken && holds(it))
    }
}

fn same(a: &Type<'_>, b: &Type<'_>) -> bool {
    match (a, b) {
        (Type::Record(a), Type::Record(b)) => std::rc::Rc::ptr_eq(a, b),
        (Type::Elementary(a), Type::Elementary(b)) => a == b,
        _ => false,
    }
}

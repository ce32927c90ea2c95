//! CODESYS and Logix compute integers and bit strings of fewer than 32 bits at 32. Such a value keeps the type
//! that its operands give it, and is cut to that where it is stored: until then its cell has 32 bits.

use crate::expressions::in_repr;
use crate::machine::{Machine, Outcome};
use crate::storage::Value;
use crate::types::{Elementary, Type};
use staunch_frontend::Span;
use staunch_runtime::{Family, Value as Scalar};

impl<'a> Machine<'a> {
    pub(crate) fn is_codesys(&self) -> bool {
        self.declared.family == Family::Codesys
    }

    /// Whether values of this type are computed at 32 bits.
    pub(crate) fn promotes(&self, ty: Elementary) -> bool {
        matches!(self.declared.family, Family::Codesys | Family::Logix) && ty.is_narrow()
    }

    /// The type at which two operands meet: of narrow numbers in CODESYS that of more bits, the signed
    /// one of as many.
    pub(crate) fn meeting(&self, a: Elementary, b: Elementary) -> Option<Elementary> {
        if self.promotes(a) && self.promotes(b) && !(a.is_bits() && b.is_bits()) {
            let order = |it: &Elementary| (it.repr().size(), !it.repr().is_unsigned());
            return [a, b].into_iter().max_by_key(order);
        }
        if self.declared.family == Family::Logix {
            // The later one of these. (1756-RM006K, p. 541)
            use Elementary as E;
            let ranks = [E::Sint, E::Usint, E::Int, E::Uint, E::Dint, E::Udint, E::Lint, E::Ulint, E::Real, E::Lreal];
            let rank = |it: E| ranks.iter().position(|ranked| *ranked == it);
            if let Some((x, y)) = rank(a).zip(rank(b)) {
                return Some(ranks[x.max(y)]);
            }
        }
        let long_with_real = |x: Elementary, y: Elementary| {
            x.is_real() && self.widening(y).is_integer() && y.repr().size() == 8 && self.is_codesys()
        };
        let known = a.meets(b).or_else(|| self.widening(a).meets(self.widening(b)));
        known.or_else(|| (long_with_real(a, b) || long_with_real(b, a)).then_some(Elementary::Lreal))
    }

    /// Whether a value is taken where one of `to` is asked for.
    pub(crate) fn widens(&self, from: Elementary, to: Elementary) -> bool {
        from.widens_to(to) || self.widening(from).widens_to(self.widening(to))
    }

    /// In CODESYS a bit string is an unsigned number too.
    fn widening(&self, ty: Elementary) -> Elementary {
        if self.is_codesys() { ty.as_number() } else { ty }
    }

    /// A value of the type, not stored yet.
    pub(crate) fn unstored(&self, value: Scalar, ty: Elementary) -> Value<'a> {
        let repr = if self.promotes(ty) { Elementary::Dint } else { ty };
        Value { ty: Type::Elementary(ty), ..in_repr(value, repr) }
    }

    /// One of the runtime's operations, at the type or at 32 bits. A comparison gives a BOOL.
    pub(crate) fn computed(&self, name: &str, ty: Elementary, operands: &[Scalar], at: Span) -> Outcome<Value<'a>> {
        let repr = if self.promotes(ty) { Elementary::Dint } else { ty };
        let operands = operands.iter().map(|it| in_repr(*it, repr).as_scalar()).collect::<Outcome<Vec<_>>>()?;
        let value = self.applied(name, repr, &operands, at)?;
        let is_test = value.ty.elementary() == Some(Elementary::Bool) && ty != Elementary::Bool;
        Ok(if is_test { value } else { Value { ty: Type::Elementary(ty), ..value } })
    }
}

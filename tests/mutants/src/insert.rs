//! What a mutant is: another operator, an integer that is one more, a condition or a NOT turned around, a `Some` that
//! is `None`, a statement left out, an arm of a `match` left out, a guard that always or never holds, a function that
//! does nothing but give a plain value. What asks for memory ahead is left as it is: no program sees it.

use std::collections::HashSet;
use syn::spanned::Spanned;
use syn::visit_mut::{self, VisitMut};
use syn::{Arm, Attribute, BinOp, Block, Expr, ExprLit, Lit, Pat, PatGuard, ReturnType, Stmt, Type, UnOp, parse_quote};

/// A mutant, and where it is in the text.
pub struct Mutant {
    pub line: usize,
    pub column: usize,
    pub change: String,
}

/// Puts the mutants of a file into it, with numbers from `first` on.
pub fn insert(file: &mut syn::File, first: u32, skip: &HashSet<u32>) -> Vec<Mutant> {
    let mut inserter = Inserter { first, skip, mutants: Vec::new() };
    inserter.visit_file_mut(file);
    inserter.mutants
}

struct Inserter<'a> {
    first: u32,
    skip: &'a HashSet<u32>,
    mutants: Vec<Mutant>,
}

impl Inserter<'_> {
    /// The number of the next mutant; `None` for one that is left out.
    fn number(&mut self, at: proc_macro2::Span, change: impl Into<String>) -> Option<u32> {
        let start = at.start();
        let number = self.first + u32::try_from(self.mutants.len()).expect("fewer than 2^32 mutants");
        self.mutants.push(Mutant { line: start.line, column: start.column + 1, change: change.into() });
        (!self.skip.contains(&number)).then_some(number)
    }

    fn binary(&mut self, expr: &mut Expr) {
        let Expr::Binary(binary) = &*expr else { return };
        let Some((op, text)) = other(&binary.op) else { return };
        if holds_let(expr) {
            return;
        }
        let Some(number) = self.number(binary.op.span(), text) else { return };
        let mut changed = binary.clone();
        changed.op = op;
        let original = binary.clone();
        *expr = parse_quote!((if crate::mutant::on(#number) { #changed } else { #original }));
    }

    fn condition(&mut self, condition: &mut Expr) {
        // Operators have mutants of their own.
        if holds_let(condition) || matches!(condition, Expr::Binary(_) | Expr::Unary(_) | Expr::Paren(_)) {
            return;
        }
        let Some(number) = self.number(condition.span(), "the condition turned around") else { return };
        *condition = parse_quote!((#condition) != crate::mutant::on(#number));
    }

    /// An arm before one that takes everything can be left out.
    fn arm(&mut self, arm: &mut Arm) {
        let Some(number) = self.number(arm.pat.span(), "the arm left out") else { return };
        let guard = parse_quote!(!crate::mutant::on(#number));
        arm.pat = Pat::Guard(PatGuard {
            attrs: Vec::new(),
            pat: Box::new(arm.pat.clone()),
            if_token: Default::default(),
            guard: Box::new(guard),
        });
    }

    fn guard(&mut self, guard: &mut Expr, at: proc_macro2::Span) {
        if holds_let(guard) {
            return;
        }
        if let Some(number) = self.number(at, "the guard always holds") {
            *guard = parse_quote!(crate::mutant::on(#number) || (#guard));
        }
        if let Some(number) = self.number(at, "the guard never holds") {
            *guard = parse_quote!(!crate::mutant::on(#number) && (#guard));
        }
    }

    /// A function of a type with plain values gives one of them, and does nothing else.
    fn body(&mut self, signature: &syn::Signature, block: &mut Block) {
        for (value, text) in plain(&signature.output) {
            let Some(number) = self.number(signature.ident.span(), format!("{} {text}", signature.ident)) else {
                continue;
            };
            let statement = parse_quote!(if crate::mutant::on(#number) { return #value; });
            block.stmts.insert(0, statement);
        }
    }
}

impl VisitMut for Inserter<'_> {
    fn visit_item_mut(&mut self, item: &mut syn::Item) {
        let (attributes, is_constant): (&[Attribute], bool) = match item {
            syn::Item::Fn(it) => (&it.attrs, it.sig.constness.is_some()),
            syn::Item::Mod(it) => (&it.attrs, false),
            syn::Item::Impl(it) => (&it.attrs, false),
            syn::Item::Trait(it) => (&it.attrs, false),
            _ => return,
        };
        if is_constant || is_test(attributes) {
            return;
        }
        visit_mut::visit_item_mut(self, item);
        if let syn::Item::Fn(it) = item {
            self.body(&it.sig, &mut it.block);
        }
    }

    fn visit_impl_item_mut(&mut self, item: &mut syn::ImplItem) {
        if let syn::ImplItem::Fn(it) = item
            && it.sig.constness.is_none()
            && !is_test(&it.attrs)
        {
            self.visit_block_mut(&mut it.block);
            self.body(&it.sig, &mut it.block);
        }
    }

    fn visit_trait_item_mut(&mut self, item: &mut syn::TraitItem) {
        if let syn::TraitItem::Fn(it) = item
            && let Some(block) = &mut it.default
        {
            self.visit_block_mut(block);
        }
    }

    fn visit_pat_mut(&mut self, pattern: &mut Pat) {
        if let Pat::Guard(it) = pattern {
            let at = it.guard.span();
            self.visit_expr_mut(&mut it.guard);
            self.guard(&mut it.guard, at);
        }
    }

    fn visit_type_mut(&mut self, _: &mut syn::Type) {}
    fn visit_generic_argument_mut(&mut self, _: &mut syn::GenericArgument) {}
    fn visit_expr_const_mut(&mut self, _: &mut syn::ExprConst) {}

    fn visit_expr_repeat_mut(&mut self, it: &mut syn::ExprRepeat) {
        self.visit_expr_mut(&mut it.expr);
    }

    fn visit_block_mut(&mut self, block: &mut Block) {
        visit_mut::visit_block_mut(self, block);
        for statement in &mut block.stmts {
            let Stmt::Expr(expr, Some(_)) = statement else { continue };
            if asks_for_memory(expr) {
                continue;
            }
            let is_effect = matches!(expr, Expr::MethodCall(_) | Expr::Call(_) | Expr::Assign(_) | Expr::Try(_))
                || matches!(expr, Expr::Binary(it) if is_compound(&it.op));
            if !is_effect {
                continue;
            }
            let Some(number) = self.number(expr.span(), "the statement left out") else { continue };
            *statement = parse_quote!(if !crate::mutant::on(#number) { #expr; });
        }
    }

    fn visit_expr_if_mut(&mut self, it: &mut syn::ExprIf) {
        visit_mut::visit_expr_if_mut(self, it);
        self.condition(&mut it.cond);
    }

    fn visit_expr_match_mut(&mut self, it: &mut syn::ExprMatch) {
        visit_mut::visit_expr_match_mut(self, it);
        let takes_all = it.arms.iter().position(|arm| matches!(arm.pat, Pat::Wild(_)));
        for arm in it.arms.iter_mut().take(takes_all.unwrap_or(0)) {
            if !matches!(arm.pat, Pat::Guard(_)) {
                self.arm(arm);
            }
        }
    }

    fn visit_expr_mut(&mut self, expr: &mut Expr) {
        if asks_for_memory(expr) {
            return;
        }
        // Of a negative number the sign belongs to the literal.
        if !matches!(expr, Expr::Unary(it) if matches!(it.op, UnOp::Neg(_)) && matches!(*it.expr, Expr::Lit(_))) {
            visit_mut::visit_expr_mut(self, expr);
        }
        match &*expr {
            Expr::Binary(_) => self.binary(expr),
            Expr::Unary(it) if matches!(it.op, UnOp::Not(_)) => {
                let Some(number) = self.number(it.op.span(), "! left out") else { return };
                let inner = &it.expr;
                *expr = parse_quote!((if crate::mutant::on(#number) { #inner } else { !#inner }));
            }
            Expr::Lit(ExprLit { lit: Lit::Int(it), .. }) => {
                let Ok(value) = it.base10_parse::<u64>() else { return };
                let more = syn::LitInt::new(&format!("{}{}", value.wrapping_add(1), it.suffix()), it.span());
                let (it, number) = (it.clone(), self.number(it.span(), format!("{value} is {more}")));
                let Some(number) = number else { return };
                *expr = parse_quote!((if crate::mutant::on(#number) { #more } else { #it }));
            }
            Expr::Call(it) if matches!(&*it.func, Expr::Path(it) if it.path.is_ident("Some")) => {
                let Some(number) = self.number(it.span(), "Some is None") else { return };
                let it = it.clone();
                *expr = parse_quote!((if crate::mutant::on(#number) { None } else { #it }));
            }
            _ => {}
        }
    }
}

/// Whether an item exists only for tests, or for some targets: what is not built cannot be changed either.
pub fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|it| it.path().is_ident("test") || it.path().is_ident("cfg"))
}

fn is_compound(op: &BinOp) -> bool {
    matches!(
        op,
        BinOp::AddAssign(_)
            | BinOp::SubAssign(_)
            | BinOp::MulAssign(_)
            | BinOp::BitAndAssign(_)
            | BinOp::BitOrAssign(_)
            | BinOp::BitXorAssign(_)
    )
}

/// Whether it is about room for what comes later, or room that is given back.
fn asks_for_memory(expr: &Expr) -> bool {
    match expr {
        Expr::MethodCall(it) => ["reserve", "reserve_exact", "shrink_to_fit"].iter().any(|name| it.method == name),
        Expr::Call(it) => {
            matches!(&*it.func, Expr::Path(it) if it.path.segments.last().is_some_and(|it| it.ident == "with_capacity" || it.ident == "with_capacity_and_hasher"))
        }
        _ => false,
    }
}

/// The plain values of what a function gives, and how they read.
fn plain(output: &ReturnType) -> Vec<(Expr, &'static str)> {
    let ReturnType::Type(_, ty) = output else { return vec![(parse_quote!(()), "does nothing")] };
    let Type::Path(ty) = &**ty else { return Vec::new() };
    let Some(last) = ty.path.segments.last() else { return Vec::new() };
    match last.ident.to_string().as_str() {
        "bool" => vec![(parse_quote!(true), "is true"), (parse_quote!(false), "is false")],
        "Option" => vec![(parse_quote!(None), "is None")],
        "String" => vec![(parse_quote!(Default::default()), "is empty")],
        "Vec" => vec![(parse_quote!(Default::default()), "is empty")],
        "usize" | "u8" | "u16" | "u32" | "u64" | "u128" | "i8" | "i16" | "i32" | "i64" | "i128" => {
            vec![(parse_quote!(0), "is 0"), (parse_quote!(1), "is 1")]
        }
        _ => Vec::new(),
    }
}

/// A condition with `let` cannot be put into a block.
fn holds_let(expr: &Expr) -> bool {
    match expr {
        Expr::Let(_) => true,
        Expr::Binary(it) => holds_let(&it.left) || holds_let(&it.right),
        _ => false,
    }
}

fn other(op: &BinOp) -> Option<(BinOp, &'static str)> {
    Some(match op {
        BinOp::Lt(_) => (parse_quote!(<=), "< is <="),
        BinOp::Le(_) => (parse_quote!(<), "<= is <"),
        BinOp::Gt(_) => (parse_quote!(>=), "> is >="),
        BinOp::Ge(_) => (parse_quote!(>), ">= is >"),
        BinOp::Eq(_) => (parse_quote!(!=), "== is !="),
        BinOp::Ne(_) => (parse_quote!(==), "!= is =="),
        BinOp::And(_) => (parse_quote!(||), "&& is ||"),
        BinOp::Or(_) => (parse_quote!(&&), "|| is &&"),
        BinOp::Add(_) => (parse_quote!(-), "+ is -"),
        BinOp::Sub(_) => (parse_quote!(+), "- is +"),
        BinOp::Mul(_) => (parse_quote!(+), "* is +"),
        BinOp::Div(_) => (parse_quote!(*), "/ is *"),
        BinOp::Rem(_) => (parse_quote!(/), "% is /"),
        BinOp::BitAnd(_) => (parse_quote!(|), "& is |"),
        BinOp::BitOr(_) => (parse_quote!(&), "| is &"),
        BinOp::BitXor(_) => (parse_quote!(&), "^ is &"),
        BinOp::Shl(_) => (parse_quote!(>>), "<< is >>"),
        BinOp::Shr(_) => (parse_quote!(<<), ">> is <<"),
        _ => return None,
    })
}

//! EXTENDS: a class is given what its base has, before anything is declared. It has the base's variables before its
//! own, and the base's routines, each a copy that works on the class itself: so a call in it of what the class
//! overrides is a call of that, and every call is known when the program is compiled.
//!
//! An overridden routine is kept only for SUPER, where something calls it so.

mod classes;

use crate::ast::{Access, Expr, ExprKind, File, Item, Name, Pou, PouKind, VarKind, each_expr};
use crate::diagnostic::{Code, Diagnostic, Missing};
use crate::log::Log;
use crate::source::Span;
use crate::spelling::{Key, nearest};
use crate::start::{EXIT, is_initial};
use classes::{Base, Classes};
use rustc_hash::{FxHashMap, FxHashSet};

/// A class extends no more than so many, one through the other.
const MAX_DEPTH: usize = 100;

/// Gives each class what it inherits.
pub(crate) fn expand<'s>(files: &mut [File<'s>], log: &mut Log<'s>) {
    let needs = |it: &Item<'_>| matches!(it, Item::Pou(pou) if inherits(pou));
    if !files.iter().flat_map(|it| &it.items).any(needs) {
        return;
    }
    let classes = Classes::of(files, log);
    let mut expansion = Expansion {
        classes: &classes,
        diagnostics: &mut log.diagnostics,
        made: FxHashMap::default(),
        named: FxHashMap::default(),
        depths: FxHashMap::default(),
        unknown: FxHashSet::default(),
        is_unknown: false,
    };
    for at in 0..classes.all.len() {
        expansion.make_all(at);
    }
    let mut made = expansion.made;
    for (at, class) in classes.all.iter().enumerate() {
        if let (Item::Pou(pou), Some(new)) = (&mut files[class.file].items[class.item], made.remove(&at)) {
            *pou = new;
        }
    }
}

/// Whether anything has to be given to a class, or held against what it says of itself.
fn inherits(pou: &Pou<'_>) -> bool {
    let Pou { kind, extends, modifiers, .. } = pou;
    let is_whole = extends.is_none() && modifiers.is_abstract.is_none() && !has_abstract(pou);
    kind.is_block() && !is_whole
}

fn has_abstract(pou: &Pou<'_>) -> bool {
    pou.routines.iter().any(|it| it.modifiers.is_abstract.is_some() || it.modifiers.overrides.is_some())
}

/// The places of a class's routines, by their names.
type Named<'s> = FxHashMap<Key<'s>, Vec<usize>>;

fn named<'s>(routines: &[Pou<'s>]) -> Named<'s> {
    let mut named = Named::default();
    for (at, routine) in routines.iter().enumerate() {
        named.entry(Key(routine.name.text)).or_default().push(at);
    }
    named
}

/// Those of a name.
fn of_name<'a, 's>(
    routines: &'a [Pou<'s>],
    named: &'a Named<'s>,
    name: &'s str,
) -> impl Iterator<Item = &'a Pou<'s>> + Clone {
    named.get(&Key(name)).into_iter().flatten().map(|at| &routines[*at])
}

struct Expansion<'c, 's> {
    classes: &'c Classes<'s>,
    diagnostics: &'c mut Vec<Diagnostic>,
    /// Those that are whole.
    made: FxHashMap<usize, Pou<'s>>,
    /// The routines of each of them.
    named: FxHashMap<usize, Named<'s>>,
    /// How many classes each extends, one through the other.
    depths: FxHashMap<usize, usize>,
    /// The classes that extend what is not known, directly or not: nobody knows what they override.
    unknown: FxHashSet<usize>,
    /// Whether the class that is made is one of them.
    is_unknown: bool,
}

impl<'s> Expansion<'_, 's> {
    /// Makes the class in a place, after those that it extends.
    fn make_all(&mut self, at: usize) {
        let (mut around, mut bases) = (Vec::new(), Vec::new());
        let mut next = Some(at).filter(|it| !self.made.contains_key(it));
        while let Some(at) = next {
            around.push(at);
            let pou = &self.classes.all[at].pou;
            let base = pou.extends.and_then(|it| self.base(pou, it, &around));
            bases.push(base);
            next = base.filter(|it| !self.made.contains_key(it));
        }
        while let (Some(at), Some(base)) = (around.pop(), bases.pop()) {
            self.make(at, base);
        }
    }

    /// Makes the class in a place, whose base is whole.
    fn make(&mut self, at: usize, base: Option<usize>) {
        let pou = &self.classes.all[at].pou;
        self.is_unknown = base.map_or(pou.extends.is_some(), |it| self.unknown.contains(&it));
        self.unknown.extend(Some(at).filter(|_| self.is_unknown));
        let base = base.filter(|it| self.is_near(at, *it));
        let inherited = base.and_then(|it| self.named.get(&it)).cloned().unwrap_or_default();
        let base = base.and_then(|it| self.made.get(&it)).cloned();
        for it in &pou.routines {
            self.check_base_of_override(it, base.as_ref(), &inherited);
        }
        let whole = match &base {
            Some(base) => self.heir(pou, base),
            None => Pou { extends: None, ..pou.clone() },
        };
        self.report_abstract(&whole, base.as_ref());
        self.named.insert(at, named(&whole.routines));
        self.made.insert(at, whole);
    }

    /// Whether a class is not too far from the first base; each has copies of what all before it have.
    fn is_near(&mut self, at: usize, base: usize) -> bool {
        let depth = self.depths.get(&base).copied().unwrap_or_default() + 1;
        self.depths.insert(at, depth.min(MAX_DEPTH + 1));
        // What extends one that is too far is so by that.
        if depth == MAX_DEPTH + 1 {
            let pou = &self.classes.all[at].pou;
            let message = format!("`{}` is more than {MAX_DEPTH} levels below its first base class", pou.name.text);
            let error = Diagnostic::new(Code::E0901, pou.name.span, message);
            self.diagnostics.push(error.label("it contains copies of the members of all of them"));
        }
        depth <= MAX_DEPTH
    }

    /// EXTENDS where IMPLEMENTS is meant; the fix is given where no IMPLEMENTS follows.
    fn interface_extended(&self, pou: &Pou<'s>, base: Name<'s>) -> Diagnostic {
        let (name, kind) = (base.text, pou.kind.word());
        let message = format!("`{name}` is an INTERFACE, which a {kind} implements");
        let error = Diagnostic::new(Code::E0102, base.span, message)
            .label("expected a class to extend")
            .help(format!("write `IMPLEMENTS {name}`"));
        let head = Span { start: pou.name.span.end, end: base.span.start, ..base.span };
        let word = self.classes.text(head).to_ascii_uppercase().find("EXTENDS");
        match word.and_then(|it| u32::try_from(it).ok()).filter(|_| pou.implements.is_empty()) {
            Some(at) => error.fix(Span { start: head.start + at, ..head }, "IMPLEMENTS "),
            None => error,
        }
    }

    fn base(&mut self, pou: &Pou<'s>, base: Name<'s>, around: &[usize]) -> Option<usize> {
        let at = match self.classes.base_of(pou, base) {
            Base::Class(at) => at,
            Base::NotHere => return None,
            Base::Interface => {
                self.diagnostics.push(self.interface_extended(pou, base));
                return None;
            }
            Base::Unknown => {
                if crate::dialect::bare_block(self.classes.dialect(base.span), base.text).is_some() {
                    let message = format!("`{}` is a standard block and cannot be extended", base.text);
                    self.diagnostics.push(
                        Diagnostic::new(Code::E0102, base.span, message)
                            .label("expected a FUNCTION_BLOCK that is declared in Structured Text")
                            .help(format!(
                                "declare an instance of {} in this FUNCTION_BLOCK, and call that",
                                base.text
                            )),
                    );
                    return None;
                }
                let others = self.classes.all.iter().map(|it| it.pou.name.text);
                let names = others.filter(|it| Key(it) != Key(pou.name.text));
                let error =
                    Diagnostic::missing(Missing::FunctionBlock, base.text, base.span).label("expected one to extend");
                self.diagnostics.push(match nearest(base.text, names) {
                    Some(near) => error.help(format!("did you mean `{near}`?")).fix(base.span, near),
                    None => error,
                });
                return None;
            }
        };
        if around.contains(&at) {
            let way: Vec<_> = around.iter().map(|it| self.classes.all[*it].pou.name.text).collect();
            self.diagnostics.push(
                Diagnostic::new(Code::E0402, base.span, format!("`{}` extends itself", pou.name.text))
                    .label("its size would be infinite")
                    .note(format!("the chain is {} -> {}", way.join(" -> "), base.text)),
            );
            return None;
        }
        if self.classes.all[at].pou.external.is_some() {
            self.diagnostics.push(
                Diagnostic::new(Code::E0319, base.span, format!("`{}` is `{{external}}`", base.text))
                    .label("it cannot be extended")
                    .help("declare an instance of it in this FUNCTION_BLOCK"),
            );
            return None;
        }
        if let Some(span) = self.classes.all[at].pou.modifiers.is_final {
            self.diagnostics.push(
                Diagnostic::new(Code::E0403, base.span, format!("`{}` is FINAL", base.text))
                    .label("it cannot be extended")
                    .other(span, "declared as such here"),
            );
        }
        Some(at)
    }

    /// A class with what its base has.
    fn heir(&mut self, own: &Pou<'s>, base: &Pou<'s>) -> Pou<'s> {
        let mut whole = own.clone();
        whole.blocks = base.blocks.iter().chain(&own.blocks).cloned().collect();
        whole.inherited = base.blocks.len();
        // By its declaration, wherever that is.
        whole.extends = Some(base.name);
        let mut hidden = Vec::new();
        let news = named(&own.routines);
        for routine in &base.routines {
            let home = routine.home.unwrap_or(base.name);
            let copy = Pou { home: Some(home), ..routine.clone() };
            let mut candidates = of_name(&own.routines, &news, routine.name.text);
            match candidates.find(|it| self.overrides(it, routine)) {
                _ if routine.is_hidden => hidden.push(copy),
                Some(new) => {
                    self.check_override(new, routine);
                    hidden.push(Pou { is_hidden: true, ..copy });
                }
                None => whole.routines.push(copy),
            }
        }
        let name = base.name;
        hidden.push(Pou {
            kind: PouKind::Action,
            // They live as long as the body runs.
            blocks: base.blocks.iter().filter(|it| it.kind == VarKind::Temp).cloned().collect(),
            body: base.body.clone(),
            home: Some(name),
            is_hidden: true,
            doc: base.doc.clone(),
            ..Pou::new(PouKind::Action, name, base.span)
        });
        self.keep_called(&mut whole, hidden);
        whole
    }

    /// Keeps of the hidden routines those that SUPER calls, directly or through others, and
    /// FB_init, and FB_exit where objects of the class are deleted.
    fn keep_called(&self, whole: &mut Pou<'s>, hidden: Vec<Pou<'s>>) {
        let mut wanted = Vec::new();
        // They run one after the other.
        let is_called = |it: &Pou<'s>| is_initial(it.name) || whole.pool.is_some() && Key(it.name.text) == Key(EXIT);
        let (initial, hidden): (Vec<_>, Vec<_>) = hidden.into_iter().partition(is_called);
        whole.routines.extend(initial);
        let mut unwanted: FxHashMap<Span, Vec<Pou<'s>>> = FxHashMap::default();
        for it in hidden {
            unwanted.entry(it.name.span).or_default().push(it);
        }
        supers(&whole.body, whole.name, &mut wanted);
        for it in &whole.routines {
            supers(&it.body, it.home.unwrap_or(whole.name), &mut wanted);
        }
        while let Some((home, name)) = wanted.pop() {
            for meant in self.meant(whole, home, name) {
                for routine in unwanted.remove(&meant).into_iter().flatten() {
                    supers(&routine.body, routine.home.unwrap_or(whole.name), &mut wanted);
                    whole.routines.push(routine);
                }
            }
        }
    }

    /// Where those routines are declared that SUPER may mean in a routine of a class; the base's body has the base's
    /// name.
    fn meant(&self, whole: &Pou<'s>, home: Name<'s>, name: Option<Name<'s>>) -> Vec<Span> {
        let made = |name| self.classes.declared(name).and_then(|at| Some((self.made.get(&at)?, self.named.get(&at)?)));
        let home = if home.span == whole.name.span { Some(whole) } else { made(home).map(|it| it.0) };
        let Some((base, named)) = home.and_then(|it| made(it.extends?)) else { return Vec::new() };
        let Some(name) = name else { return vec![base.name.span] };
        let is_seen = |it: &&Pou<'s>| !it.is_hidden;
        of_name(&base.routines, named, name.text).filter(is_seen).map(|it| it.name.span).collect()
    }

    /// Whether a routine overrides one of its base.
    fn overrides(&self, new: &Pou<'s>, old: &Pou<'s>) -> bool {
        let may_differ = self.classes.may_be_overloaded(new) && self.classes.may_be_overloaded(old);
        is_same(new, old) && (!may_differ || self.classes.have_same_parameters(new, old))
    }

    fn check_override(&mut self, new: &Pou<'s>, old: &Pou<'s>) {
        if let Some(span) = old.modifiers.is_final {
            self.diagnostics.push(
                Diagnostic::new(Code::E0403, new.name.span, format!("`{}` is FINAL", old.name.text))
                    .label("it cannot be overridden")
                    .other(span, "declared as such here"),
            );
        }
        let rank = |it: &Pou<'_>| match it.modifiers.access {
            None | Some((Access::Public, _)) => 2,
            Some((Access::Internal | Access::Protected, _)) => 1,
            Some((Access::Private, _)) => 0,
        };
        if let Some((access, span)) = new.modifiers.access
            && rank(new) < rank(old)
        {
            let message =
                format!("`{}` is {}, but the declaration that it overrides is not", new.name.text, access.word());
            self.diagnostics.push(
                Diagnostic::new(Code::E0403, span, message)
                    .label("calls through the base class would still reach it")
                    .other(old.name.span, "overridden here"),
            );
        }
        if let Some((Access::Private, span)) = old.modifiers.access {
            self.diagnostics.push(
                Diagnostic::new(Code::E0403, new.name.span, format!("`{}` of the base is PRIVATE", old.name.text))
                    .label("a PRIVATE METHOD cannot be overridden: use another name here")
                    .other(span, "declared as such here"),
            );
        }
    }

    /// Reports OVERRIDE where nothing is overridden.
    fn check_base_of_override(&mut self, new: &Pou<'s>, base: Option<&Pou<'s>>, named: &Named<'s>) {
        let routines = base.map_or(&[][..], |it| &it.routines);
        let mut candidates = of_name(routines, named, new.name.text).filter(|it| !it.is_hidden);
        let Some(span) = new.modifiers.overrides.filter(|_| !self.is_unknown) else { return };
        if candidates.clone().any(|it| self.overrides(new, it)) {
            return;
        }
        let message = match base {
            Some(base) => format!("`{}` has no `{}` to override", base.name.text, new.name.text),
            None => "this overrides nothing: the FUNCTION_BLOCK does not extend another".to_owned(),
        };
        let error = Diagnostic::new(Code::E0403, span, message);
        self.diagnostics.push(match candidates.find(|it| is_same(it, new)) {
            Some(other) => error
                .label("the base has none with these parameters")
                .other(other.name.span, "it has this one")
                .help("use the same parameters, or delete OVERRIDE to add an overload"),
            None => error.help("delete OVERRIDE").fix(span, ""),
        });
    }

    /// Reports a class that is not ABSTRACT, with an ABSTRACT method that nobody has overridden.
    fn report_abstract(&mut self, pou: &Pou<'s>, base: Option<&Pou<'s>>) {
        if pou.modifiers.is_abstract.is_some() {
            return;
        }
        // A base that is not ABSTRACT has been reported for its own.
        let is_open = base.is_some_and(|it| it.modifiers.is_abstract.is_some());
        for routine in pou.routines.iter().filter(|it| !it.is_hidden && (is_open || it.home.is_none())) {
            let Some(span) = routine.modifiers.is_abstract else { continue };
            let message = format!("`{}` is not ABSTRACT, but has no body for `{}`", pou.name.text, routine.name.text);
            self.diagnostics.push(
                Diagnostic::new(Code::E0403, pou.name.span, message)
                    .label("a call of it would have no body to run")
                    .other(span, "ABSTRACT here")
                    .help(format!("override `{}`, or make the FUNCTION_BLOCK ABSTRACT", routine.name.text)),
            );
        }
    }
}

/// Whether two routines have one name, and are of one kind.
fn is_same(a: &Pou<'_>, b: &Pou<'_>) -> bool {
    let role = |kind| match kind {
        PouKind::Getter => 1,
        PouKind::Setter => 2,
        PouKind::Program
        | PouKind::FunctionBlock
        | PouKind::Class
        | PouKind::Interface
        | PouKind::Function
        | PouKind::Test
        | PouKind::Action
        | PouKind::Method => 0,
    };
    Key(a.name.text) == Key(b.name.text) && role(a.kind) == role(b.kind)
}

/// What a body calls by SUPER, with the class that the body is of; without a name its base's body.
fn supers<'s>(body: &[crate::ast::Statement<'s>], home: Name<'s>, found: &mut Vec<(Name<'s>, Option<Name<'s>>)>) {
    each_expr(body, &mut |it| match &it.kind {
        ExprKind::Member(base, name) if is_super(base) => found.push((home, Some(*name))),
        ExprKind::Call(callee, _) if is_super(callee) => found.push((home, None)),
        _ => {}
    });
}

/// `SUPER^`, and the standard's `SUPER`.
pub(crate) fn is_super(expr: &Expr<'_>) -> bool {
    match &expr.bare().kind {
        ExprKind::Deref(inner) => is_super(inner),
        ExprKind::Name(name) => name.text.eq_ignore_ascii_case("SUPER"),
        _ => false,
    }
}

//! What is known around a place, without the bodies that are elsewhere, is what a check of the whole program knows there.

mod support;

use staunch_frontend::{Asked, DefId, Index, Meaning, Span, Stop, index, without_bodies};
use support::programs::{Program, sample};

#[test]
fn names_mean_the_same_around_a_place_and_in_the_whole_program() {
    let (mut count, mut wrong) = (0, Vec::new());
    for program in sample(12) {
        let Program { name, sources, options, .. } = &program;
        let (whole, extended) = index(sources, options, Asked::All, &Stop::default());
        let all = extended.as_ref().unwrap_or(sources);
        let own = |it: &&staunch_frontend::Use| usize::from(it.span.file) < sources.files().len();
        // A few names of each, from all over it.
        let uses: Vec<_> = whole.uses.iter().filter(own).collect();
        for it in uses.iter().step_by(uses.len() / 12 + 1) {
            let mut heads = sources.clone();
            for file in (0u16..).take(sources.files().len()).filter(|file| *file != it.span.file) {
                heads.put(file, without_bodies(sources, file));
            }
            let (near, _) = index(&heads, options, Asked::Around(it.span.file, it.span.start), &Stop::default());
            count += 1;
            let found = near.at(it.span.file, it.span.start);
            if found.map(|(span, meaning)| (span, declared(&near, &meaning)))
                != Some((it.span, declared(&whole, &it.meaning)))
            {
                wrong.push(format!("{name}: {} at {}", all.text(it.span), it.span.start));
            }
        }
    }
    assert!(count > 800, "{count} names");
    assert!(wrong.is_empty(), "{} of {count}: {:#?}", wrong.len(), &wrong[..wrong.len().min(40)]);
}

/// A meaning, of a declaration where that is: other bodies may declare labels.
fn declared(index: &Index, meaning: &Meaning) -> Result<Span, Meaning<DefId>> {
    match meaning {
        Meaning::Definition(id) => Ok(index.get(*id).name),
        other => Err(other.clone()),
    }
}

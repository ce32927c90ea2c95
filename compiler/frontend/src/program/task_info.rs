//! What is known of the tasks before any of them runs: the initial values of TwinCAT's `_TaskInfo` and `_AppInfo`.

use super::configuration::{LOWEST_PRIORITY, Timing};
use crate::tasks::{self, OF_PROGRAM, OF_TASKS};
use crate::types::declarations::Declarations;
use staunch_ir::{Chars, Const, Type, Value};

/// Nanoseconds in a unit of `CycleTime`.
const UNIT: i64 = 100;

impl Declarations<'_> {
    /// Of all tasks that are declared, in order, the name and what the source says of it.
    pub(super) fn set_task_info(&mut self, tasks: &[(&str, Timing)]) {
        let Some(home) = self.pous.iter().find(|it| it.ast.name.text == tasks::BEGIN).map(|it| it.ast.name.span.file)
        else {
            return;
        };
        let declared =
            |name: &str| self.globals.iter().position(|it| it.name.text == name && it.name.span.file == home);
        let [Some(of_tasks), Some(of_program)] = [OF_TASKS, OF_PROGRAM].map(declared) else {
            return;
        };
        let mut count = 0;
        if let Some((field, Type::Array(id))) = self.field_of_global(of_tasks) {
            let array = self.program.array(id);
            let unknown = ("", Timing { interval: None, priority: LOWEST_PRIORITY });
            let tasks = tasks.iter().chain(std::iter::repeat(&unknown));
            let one = |(_, it)| (1, self.members(array.element, |name| of_task(name, it)));
            let values: Vec<_> = (array.low..=array.high).zip(tasks).map(one).collect();
            count = values.len();
            self.start_as(field, Const::Array(values));
        }
        if let Some((field, ty)) = self.field_of_global(of_program) {
            let project = self.log.sources.project().unwrap_or_default();
            let value = self.members(ty, |name| of_program_member(name, count, project));
            self.start_as(field, value);
        }
    }

    /// The field of a global variable, and its type; a program with mistakes may lack it.
    fn field_of_global(&self, at: usize) -> Option<(usize, Type)> {
        let field = self.addresses.field_of_global(at)?;
        Some((field, self.program.structure(self.program.globals).fields.get(field)?.ty))
    }

    fn start_as(&mut self, field: usize, value: Const) {
        let globals = self.program.globals;
        self.program.structs[globals.index()].fields[field].initial = value;
    }

    fn members(&self, ty: Type, value: impl Fn(&str) -> Const) -> Const {
        let Type::Struct(id) = ty else { return Const::Zero };
        Const::Struct(self.program.structure(id).fields.iter().map(|it| value(&it.name)).collect())
    }
}

fn of_task(member: &str, (name, timing): &(&str, Timing)) -> Const {
    match member {
        "CycleTime" => {
            Const::Scalar(Value::U32(u32::try_from(timing.interval.unwrap_or(0) / UNIT).unwrap_or(u32::MAX)))
        }
        "Priority" => Const::Scalar(Value::U16(u16::try_from(timing.priority).unwrap_or(u16::MAX))),
        "TaskName" => text(name),
        _ => Const::Zero,
    }
}

fn of_program_member(member: &str, tasks: usize, project: &str) -> Const {
    match member {
        "TaskCnt" => Const::Scalar(Value::U32(u32::try_from(tasks).unwrap_or(u32::MAX))),
        "ProjectName" => text(project),
        _ => Const::Zero,
    }
}

/// What a STRING(63) keeps of a name.
fn text(name: &str) -> Const {
    let mut chars = Chars::Narrow(name.bytes().collect());
    chars.cut(63);
    if chars.is_empty() { Const::Zero } else { Const::Text(chars) }
}

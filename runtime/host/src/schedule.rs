//! When which program runs.

use crate::map::Map;
use staunch_runtime::Time;

/// Time between scans if neither the command nor the source sets it.
pub const DEFAULT_CYCLE: Time = 10_000_000;

#[derive(Clone, Debug)]
pub(crate) struct Schedule {
    /// In the order in which programs that are due at the same time run.
    tasks: Vec<Task>,
    /// Scans fall on multiples of it.
    tick: Option<Time>,
    /// When the next scan is due.
    next: Time,
    due: Vec<Due>,
}

/// A program that is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Due {
    pub instance: usize,
    /// From one of its scans to the next.
    pub period: Time,
}

/// A scan of one program, in real time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Turn {
    pub program: Due,
    /// When it was due.
    pub due: Time,
    /// Scans that are left out before the next one.
    pub missed: u64,
    /// When the next one is due that is not left out for want of time so far.
    pub next: Time,
}

#[derive(Clone, Copy, Debug)]
struct Task {
    program: Due,
    next: Time,
}

impl Task {
    /// The scan after one at `now`, which falls on the period from the last one on, or from `now` if that was `placed`.
    #[inline]
    fn step(&mut self, now: Time, placed: bool) {
        let from = if placed { now } else { self.next };
        let late = now.saturating_sub(from);
        let period = self.program.period;
        // The division costs as much as all the rest, and most scans are not that late.
        let missed = if late < period { 0 } else { late / period };
        self.next = from.saturating_add(period.saturating_mul(missed + 1));
    }
}

impl Schedule {
    /// `cycle` takes the place of the programs' intervals. Where they differ it cannot, and is
    /// the grid on which they fall.
    pub fn new(map: &Map, running: &[usize], cycle: Option<Time>) -> Self {
        let mut intervals: Vec<Time> = running.iter().filter_map(|at| map.instances[*at].interval).collect();
        intervals.sort_unstable();
        intervals.dedup();
        let tick = cycle.filter(|_| intervals.len() > 1);
        let period = |at: usize| match (cycle, map.instances[at].interval) {
            (Some(cycle), _) if tick.is_none() => cycle,
            (_, Some(interval)) => interval,
            (cycle, None) => cycle.unwrap_or(DEFAULT_CYCLE),
        };
        let mut order = running.to_vec();
        order.sort_by_key(|at| (map.instances[*at].priority, *at));
        let task = |instance| Task { program: Due { instance, period: period(instance) }, next: 0 };
        Self { tasks: order.into_iter().map(task).collect(), tick, next: 0, due: Vec::with_capacity(running.len()) }
    }

    /// When the next scan is due.
    pub fn next(&self) -> Time {
        self.next
    }

    /// The programs that run at `now`. At least one does. After a scan that was `placed` at
    /// `now`, the next follows a period later.
    pub fn advance(&mut self, now: Time, placed: bool) -> &[Due] {
        let threshold = self.earliest().max(now);
        self.due.clear();
        for task in self.tasks.iter_mut().filter(|it| it.next <= threshold) {
            self.due.push(task.program);
            task.step(now, placed);
        }
        self.next = self.on_grid(self.earliest());
        &self.due
    }

    /// The program that runs at `now`, alone: that of the highest priority among those that are due. Its next scan follows on
    /// its period, or a period later where this one was `placed`; one that `catches_up` leaves none out.
    pub fn pick(&mut self, now: Time, placed: bool, catches_up: bool) -> Option<Turn> {
        let threshold = self.earliest().max(now);
        let at = self.tasks.iter().position(|it| it.next <= threshold)?;
        let due = if placed { now } else { self.on_grid(self.tasks[at].next) };
        let task = &mut self.tasks[at];
        let before = task.next;
        task.step(if catches_up && !placed { before } else { now }, placed);
        let (program, next) = (task.program, task.next);
        let steps = if placed { 1 } else { next.saturating_sub(before) / program.period };
        self.next = self.on_grid(self.earliest());
        Some(Turn { program, due, missed: u64::try_from(steps - 1).unwrap_or(0), next })
    }

    /// The programs, in the order in which they run if they are due at the same time.
    pub fn programs(&self) -> impl Iterator<Item = Due> {
        self.tasks.iter().map(|it| it.program)
    }

    /// The [only](Self::only) program's next scan follows a period after this one.
    #[inline]
    pub fn step(&mut self) {
        if let [task] = self.tasks.as_mut_slice() {
            task.next = task.next.saturating_add(task.program.period);
            self.next = task.next;
        }
    }

    fn earliest(&self) -> Time {
        self.tasks.iter().map(|it| it.next).min().unwrap_or(0)
    }

    fn on_grid(&self, time: Time) -> Time {
        match self.tick {
            Some(tick) => time.div_euclid(tick).saturating_add(Time::from(time % tick != 0)).saturating_mul(tick),
            None => time,
        }
    }

    pub fn shortest_period(&self) -> Time {
        self.tasks.iter().map(|it| it.program.period).min().unwrap_or(DEFAULT_CYCLE)
    }

    /// For each program, when it is due.
    pub fn times(&self) -> impl Iterator<Item = Time> {
        self.tasks.iter().map(|it| it.next)
    }

    /// Goes back to what [`times`](Self::times) gave.
    pub fn set_times(&mut self, times: &[Time]) {
        self.tasks.iter_mut().zip(times).for_each(|(task, next)| task.next = *next);
        self.next = self.on_grid(self.earliest());
    }

    /// What [`advance`](Self::advance) returned last.
    pub fn due(&self) -> &[Due] {
        &self.due
    }

    /// The program, if there is only one.
    pub fn only(&self) -> Option<Due> {
        match self.tasks.as_slice() {
            [task] => Some(task.program),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Instance;

    fn times(intervals: &[(Option<Time>, u32)], cycle: Option<Time>, count: usize) -> Vec<(Time, Vec<usize>)> {
        let mut map = crate::fixture::map();
        let first = map.instances[0].clone();
        let instance = |(interval, priority): &(Option<Time>, u32)| Instance {
            interval: *interval,
            priority: *priority,
            ..first.clone()
        };
        map.instances = intervals.iter().map(instance).collect();
        let running: Vec<usize> = (0..intervals.len()).collect();
        let mut schedule = Schedule::new(&map, &running, cycle);
        let step = |_| {
            let now = schedule.next();
            (now, schedule.advance(now, false).iter().map(|it| it.instance).collect())
        };
        (0..count).map(step).collect()
    }

    #[test]
    fn one_program_runs_every_cycle() {
        let ms = 1_000_000;
        assert_eq!(times(&[(None, 0)], None, 2)[1].0, 10 * ms);
        assert_eq!(times(&[(Some(20 * ms), 0)], None, 2)[1].0, 20 * ms);
        assert_eq!(times(&[(Some(20 * ms), 0)], Some(5 * ms), 2)[1].0, 5 * ms);
    }

    #[test]
    fn tasks_keep_their_own_intervals() {
        let expected = [(0, vec![1, 0]), (20, vec![0]), (30, vec![1]), (40, vec![0]), (60, vec![1, 0])];
        assert_eq!(times(&[(Some(20), 5), (Some(30), 1)], None, 5), expected);
        let on_grid = [(0, vec![1, 0]), (24, vec![0]), (36, vec![1]), (48, vec![0]), (60, vec![1, 0])];
        assert_eq!(times(&[(Some(20), 5), (Some(30), 1)], Some(12), 5), on_grid);
    }

    /// What runs at a time, and when that was due.
    fn picked(schedule: &mut Schedule, now: Time, catches_up: bool) -> (usize, Time, u64, Time) {
        let turn = schedule.pick(now, false, catches_up).unwrap();
        (turn.program.instance, turn.due, turn.missed, turn.next)
    }

    #[test]
    fn the_highest_priority_is_next() {
        let mut map = crate::fixture::map();
        let first = map.instances[0].clone();
        let instance = |interval, priority| Instance { interval: Some(interval), priority, ..first.clone() };
        map.instances = vec![instance(100, 5), instance(30, 1)];
        let mut schedule = Schedule::new(&map, &[0, 1], None);
        assert_eq!(picked(&mut schedule, 0, false), (1, 0, 0, 30));
        assert_eq!(picked(&mut schedule, 1, false), (0, 0, 0, 100));
        // A long scan of the other has ended at 75.
        assert_eq!(picked(&mut schedule, 75, false), (1, 30, 1, 90));
        assert_eq!(schedule.next(), 90);
        assert_eq!(picked(&mut schedule, 130, false), (1, 90, 1, 150));
        assert_eq!(picked(&mut schedule, 131, false), (0, 100, 0, 200));
        assert_eq!(picked(&mut schedule, 240, true), (1, 150, 0, 180));
        assert_eq!(picked(&mut schedule, 240, true), (1, 180, 0, 210));
    }

    #[test]
    fn a_placed_scan_moves_those_after_it() {
        let mut schedule = Schedule::new(&crate::fixture::map(), &[0], Some(10));
        let program = Due { instance: 0, period: 10 };
        assert_eq!(schedule.advance(0, false), [program]);
        assert_eq!(schedule.advance(3, true), [program]);
        assert_eq!(schedule.next(), 13);
        assert_eq!(schedule.advance(45, false), [program]);
        assert_eq!(schedule.next(), 53);
    }
}

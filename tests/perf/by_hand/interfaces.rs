/// What implements the interface; a call is a `match`.
#[derive(Clone, Copy)]
enum Filter {
    Sum(i32),
    Peak(i32),
    Last(i32),
}

impl Filter {
    #[inline]
    fn step(&mut self, x: i32) -> i32 {
        match self {
            Self::Sum(total) => {
                *total = total.wrapping_add(x);
                *total
            }
            Self::Peak(most) => {
                *most = x.max(*most);
                *most
            }
            Self::Last(before) => core::mem::replace(before, x),
        }
    }
}

pub struct Program {
    pub value: i32,
    pub out: i32,
    filters: [Filter; 6],
}

impl Program {
    pub const NEW: Self = Self {
        value: 0,
        out: 0,
        filters: [
            Filter::Sum(0),
            Filter::Peak(0),
            Filter::Last(0),
            Filter::Sum(0),
            Filter::Peak(0),
            Filter::Last(0),
        ],
    };

    pub fn scan(&mut self, _: i64) {
        for (i, filter) in (0..).zip(&mut self.filters) {
            self.out = self.out.wrapping_add(filter.step(self.value.wrapping_add(i)));
        }
    }
}

//! What a program uses of the language, as far as a system may compute it in its own way.

use staunch_runtime::{Class, Elementary, Location};

/// One such thing. Classes of types are those of the operands; a use of a class is one of the classes around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// The program computes with the type, or converts it. Choosing and comparing do not count: they make no new values.
    Type(Elementary),
    /// A standard function, by its name in the tables: `LEFT`, also where `LEFT_STRING` is written.
    Function(&'static str),
    /// An operator with an operand of the class: `MOD`. `ADD(a, b)` is `+`, and the sign `-` is `NEG`.
    Operator(&'static str, Class),
    /// From one class to another, by a function or by itself.
    Conversion(Class, Class),
    /// A part of the language: `VAR_TEMP`.
    Part(Part),
}

/// A part of the language that a system may run in its own way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A call with an input EN.
    Enable,
    /// A VAR_TEMP of a block or a PROGRAM.
    Temp,
    /// A FOR that leaves its counter no value beyond its limit.
    LimitOfType,
    /// A timer whose PT changes while it may run. No program notes it: that shows when all is known.
    MovingPreset,
    /// An assignment to a variable of a subrange that faults. No program notes it, since most have none.
    Subrange,
    /// A division of integers, or MOD, by 0 that is reached. No program notes it: most divide by what is not 0.
    DivisionByZero,
    /// A comparison of durations with one that is not a whole number of binary fractions of a second, or of two variables;
    /// and a literal with decimals of minutes, hours or days.
    ComparedTimes,
    /// A timer in scans whose interval is not a whole number of milliseconds. No program notes it: that is a matter of its run.
    PartsOfMillisecond,
    /// A number with a fraction that a REAL does not hold exactly, in an operation with a REAL.
    FractionBesideReal,
    /// A shift by a negative number, or by as many bits as C shifts in, or more.
    ShiftPastWidth,
    /// SHL or SHR of a number without a type.
    ShiftOfConstant,
    /// A result beyond a signed type of 32 or 64 bits, where that decides something.
    Overflow,
    /// A result beyond a signed type of 32 or 64 bits, wherever it goes.
    StoredOverflow,
    /// An index outside of its array that is reached. No program notes it.
    Index,
    /// An enumeration whose default, or whose first number, is not 0.
    EnumStart,
    /// A subrange without 0.
    SubrangeStart,
    /// A TYPE that is another name of an integer or of bits, or a subrange.
    NamedNumber,
    /// A TYPE that is a STRING of a length, or an array of them.
    NamedText,
    /// A VAR_OUTPUT of a FUNCTION or METHOD.
    FunctionOutput,
    /// An input of a FUNCTION with an initial value.
    FunctionDefault,
    /// An operand that another operand changes.
    EvaluationOrder,
    /// A VAR_IN_OUT of a FUNCTION_BLOCK that is given what is global, or what another is given. Programs note only that an output
    /// is.
    InOutCopied,
    /// A VAR_IN_OUT or VAR_OUTPUT of a FUNCTION or METHOD that is given what is global, or what another is given. Programs
    /// note only that an output is.
    InOutOfFunctionCopied,
    /// An input of an instance that another argument of its call reads.
    InputReadInCall,
    /// The target of an output that the call, or a target before it, changes.
    TargetChanged,
    /// A METHOD whose named arguments are not those that it declares first, in their order.
    NamedOrder,
    /// A FUNCTION_BLOCK with a VAR_IN_OUT whose call gives arguments by position.
    PositionsOfBlock,
    /// A PROGRAM without a TASK, where another has one.
    NoTask,
    /// A comparison of two texts that are literals.
    ComparedLiterals,
    /// A product or a quotient of a TIME and a REAL.
    TimeByReal,
}

impl Part {
    pub const ALL: [Self; 30] = [
        Self::Enable,
        Self::Temp,
        Self::LimitOfType,
        Self::MovingPreset,
        Self::Subrange,
        Self::DivisionByZero,
        Self::ComparedTimes,
        Self::PartsOfMillisecond,
        Self::FractionBesideReal,
        Self::ShiftPastWidth,
        Self::ShiftOfConstant,
        Self::Overflow,
        Self::StoredOverflow,
        Self::Index,
        Self::EnumStart,
        Self::SubrangeStart,
        Self::NamedNumber,
        Self::NamedText,
        Self::FunctionOutput,
        Self::FunctionDefault,
        Self::EvaluationOrder,
        Self::InOutCopied,
        Self::InOutOfFunctionCopied,
        Self::InputReadInCall,
        Self::TargetChanged,
        Self::NamedOrder,
        Self::PositionsOfBlock,
        Self::NoTask,
        Self::ComparedLiterals,
        Self::TimeByReal,
    ];

    /// In words, for tables and messages.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Enable => "EN",
            Self::Temp => "VAR_TEMP",
            Self::LimitOfType => "FOR to the limit of its counter's type",
            Self::MovingPreset => "a PT that moves",
            Self::Subrange => "a value outside of a subrange",
            Self::DivisionByZero => "integer division by 0",
            Self::ComparedTimes => "a comparison of TIMEs",
            Self::PartsOfMillisecond => "a timer, where the time between scans is not a whole number of milliseconds",
            Self::FractionBesideReal => "a number with a fraction in an operation with a REAL",
            Self::ShiftPastWidth => "a shift past the width",
            Self::ShiftOfConstant => "a shift of a number without a type",
            Self::Overflow => "signed overflow",
            Self::StoredOverflow => "a DINT or LINT that passes its range",
            Self::Index => "an index outside of its array",
            Self::EnumStart => "an enumeration that does not start with 0",
            Self::SubrangeStart => "a subrange without 0",
            Self::NamedNumber => "a TYPE that is an integer or bits",
            Self::NamedText => "a STRING of a length in a TYPE or an array",
            Self::FunctionOutput => "VAR_OUTPUT of a FUNCTION or METHOD",
            Self::FunctionDefault => "an initial value of an input of a FUNCTION",
            Self::EvaluationOrder => "an operand or argument that another one changes",
            Self::InOutCopied => "a VAR_IN_OUT for what is global or given twice",
            Self::InOutOfFunctionCopied => "a VAR_IN_OUT of a FUNCTION for what is global or given twice",
            Self::InputReadInCall => "an input that another argument of its call reads",
            Self::TargetChanged => "the target of an output that its call changes",
            Self::NamedOrder => "named arguments of a METHOD in another order than it declares them",
            Self::PositionsOfBlock => "a call of a FUNCTION_BLOCK with a VAR_IN_OUT by position",
            Self::NoTask => "a PROGRAM without a TASK, where another has one",
            Self::ComparedLiterals => "a comparison of two texts that are literals",
            Self::TimeByReal => "a TIME multiplied with a REAL, or divided by one",
        }
    }
}

impl Use {
    /// In words, for tables and messages.
    pub fn words(self) -> String {
        match self {
            Self::Type(it) => it.name().to_owned(),
            Self::Function(name) => name.to_owned(),
            Self::Part(it) => it.words().to_owned(),
            Self::Operator(operator, class) => format!("`{operator}` of {}", class.name()),
            Self::Conversion(from, to) => format!("a conversion from {} to {}", of_class(from), of_class(to)),
        }
    }

    /// Whether what is found in a program is a use of this.
    fn covers(self, found: Self) -> bool {
        match (self, found) {
            (Self::Operator(own, class), Self::Operator(other, of)) => own == other && class.contains(of),
            (Self::Conversion(from, to), Self::Conversion(own, other)) => from.contains(own) && to.contains(other),
            (Self::Type(_) | Self::Function(_) | Self::Part(_), _) => self == found,
            (Self::Operator(..) | Self::Conversion(..), _) => false,
        }
    }
}

/// The values of a class, in words.
const fn of_class(class: Class) -> &'static str {
    match class {
        Class::String | Class::Chars => "a STRING",
        Class::Char => "a CHAR",
        Class::Duration => "a TIME",
        Class::Date => "a date or time of day",
        Class::Real => "a REAL",
        Class::Int | Class::Signed | Class::Unsigned => "an integer",
        Class::Num | Class::Magnitude => "a number",
        Class::Bit => "a bit string",
        Class::Elementary => "a value",
        Class::Any => "anything",
    }
}

/// What a program uses, each with the first place in its source. Operations of constant expressions are included. They are few
/// and noted often: a list is quicker than a table.
#[derive(Clone, Debug, Default)]
pub struct Uses(Vec<(Use, Location)>);

impl Uses {
    /// Notes a use, at the first place that has it.
    pub fn note(&mut self, found: Use, at: Location) {
        let key = |at: Location| (at.file, at.line, at.column);
        match self.0.iter_mut().find(|it| it.0 == found) {
            Some((_, first)) => *first = std::cmp::min_by_key(*first, at, |it| key(*it)),
            None => self.0.push((found, at)),
        }
    }

    /// The first place that uses it.
    pub fn first(&self, wanted: Use) -> Option<Location> {
        let found = self.0.iter().filter(|it| wanted.covers(it.0)).map(|it| it.1);
        found.min_by_key(|it| (it.file, it.line, it.column))
    }
}

#[cfg(test)]
mod tests {
    use super::{Use, Uses};
    use staunch_runtime::{Class, Elementary, Location};

    const fn at(line: u32) -> Location {
        Location { file: 0, column: 1, line }
    }

    #[test]
    fn a_class_has_the_uses_of_its_parts() {
        let mut uses = Uses::default();
        uses.note(Use::Operator("/", Class::Signed), at(7));
        uses.note(Use::Operator("/", Class::Unsigned), at(4));
        uses.note(Use::Conversion(Class::Real, Class::Signed), at(5));
        uses.note(Use::Type(Elementary::Time), at(9));
        uses.note(Use::Type(Elementary::Time), at(8));
        uses.note(Use::Function("LEFT"), at(2));
        let found = |wanted| uses.first(wanted).map(|it| it.line);
        assert_eq!(found(Use::Operator("/", Class::Int)), Some(4));
        assert_eq!(found(Use::Operator("/", Class::Real)), None);
        assert_eq!(found(Use::Operator("*", Class::Int)), None);
        assert_eq!(found(Use::Conversion(Class::Real, Class::Int)), Some(5));
        assert_eq!(found(Use::Conversion(Class::Int, Class::Real)), None);
        assert_eq!(found(Use::Type(Elementary::Time)), Some(8));
        assert_eq!(found(Use::Type(Elementary::Ltime)), None);
        assert_eq!(found(Use::Function("LEFT")), Some(2));
        assert_eq!(found(Use::Function("RIGHT")), None);
    }
}

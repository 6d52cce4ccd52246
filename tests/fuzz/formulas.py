"""The formulas of case files, evaluated independently of the program: docs/case-format.md, "Formulas".

A Formula is evaluated on arrays of points. It may have kinks or jumps on the zero sets of the functions `kinks`; quadrature
rules are cut there.
"""

import re
from dataclasses import dataclass, field

import numpy as np

TOKEN = re.compile(r"\s*(?:(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[A-Za-z_]\w*|<=|>=|==|!=|&&|\|\||[-+*/^<>?:(),])")

FUNCTIONS = {
    "rint": lambda x: np.floor(x + 0.5),  # as muParser; np.rint rounds halves to even
    "sqrt": np.sqrt,
    "exp": np.exp,
    "ln": np.log,
    "log": np.log,
    "log2": np.log2,
    "log10": np.log10,
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "tanh": np.tanh,
    "asinh": np.arcsinh,
    "acosh": np.arccosh,
    "atanh": np.arctanh,
    "atan2": np.arctan2,
}
COMPARISONS = {
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
    "==": np.equal,
    "!=": np.not_equal,
}


@dataclass
class Formula:
    """points x d -> values. A number is also a formula."""

    value: object  # function of the columns of the points
    is_constant: bool = True
    kinks: list = field(default_factory=list)

    def __call__(self, points):
        with np.errstate(all="ignore"):
            values = np.asarray(self.value(np.asarray(points).T), dtype=float)
        return np.broadcast_to(values, (len(points),))


def formula(datum):
    """From a number or a text."""
    return Parser(datum).formula() if isinstance(datum, str) else Formula(lambda x: float(datum))


class Parser:
    """By recursive descent: ternary, ||, &&, comparisons, + -, * /, sign, ^."""

    def __init__(self, text):
        self.tokens = []
        at = 0
        while text[at:].strip():
            match = TOKEN.match(text, at)
            if not match:
                raise ValueError(f"formula {text!r} at {at}")
            self.tokens.append(match.group().strip())
            at = match.end()
        self.tokens.append("")
        self.kinks = []
        self.names = set()

    def formula(self):
        value = self.ternary()
        self.expect("")
        return Formula(value, not self.names & {"x", "y", "z"}, self.kinks)

    def next_is(self, *tokens):
        return self.tokens.pop(0) if self.tokens[0] in tokens else None

    def expect(self, token):
        if self.tokens.pop(0) != token:
            raise ValueError(f"formula: {token!r} is missing")

    def ternary(self):
        condition = self.alternatives()
        if not self.next_is("?"):
            return condition
        first = self.ternary()
        self.expect(":")
        second = self.ternary()
        return lambda x: np.where(condition(x) != 0, first(x), second(x))

    def binary(self, operand, operators):
        left = operand()
        while token := self.next_is(*operators):
            left = self.combined(operators[token], left, operand())
        return left

    @staticmethod
    def combined(operation, left, right):
        return lambda x: operation(left(x), right(x))

    def alternatives(self):
        return self.binary(self.conjunction, {"||": lambda a, b: 1.0 * ((a != 0) | (b != 0))})

    def conjunction(self):
        return self.binary(self.comparison, {"&&": lambda a, b: 1.0 * ((a != 0) & (b != 0))})

    def comparison(self):
        left = self.sum()
        while token := self.next_is(*COMPARISONS):
            right = self.sum()
            self.kinks.append(self.combined(np.subtract, left, right))
            left = self.combined(lambda a, b, compare=COMPARISONS[token]: 1.0 * compare(a, b), left, right)
        return left

    def sum(self):
        return self.binary(self.product, {"+": np.add, "-": np.subtract})

    def product(self):
        return self.binary(self.sign, {"*": np.multiply, "/": np.true_divide})

    def sign(self):
        if token := self.next_is("-", "+"):
            operand = self.sign()
            return (lambda x: -operand(x)) if token == "-" else operand
        return self.power()

    def power(self):
        base = self.atom()
        if not self.next_is("^"):
            return base
        return self.combined(np.power, base, self.sign())

    def atom(self):
        token = self.tokens.pop(0)
        if token == "(":
            inner = self.ternary()
            self.expect(")")
            return inner
        if token[0].isalpha():
            return self.call(token) if self.next_is("(") else self.name(token)
        number = float(token)
        return lambda x: number

    def name(self, name):
        self.names.add(name)
        constants = {"pi": np.pi, "e": np.e}
        if name in constants:
            return lambda x: constants[name]
        axis = "xyz".index(name)
        return lambda x: x[axis]

    def call(self, name):
        arguments = [self.ternary()]
        while self.next_is(","):
            arguments.append(self.ternary())
        self.expect(")")
        first = arguments[0]
        if name in ("abs", "sign"):
            self.kinks.append(first)
            return self.applied(getattr(np, name), arguments)
        if name in ("min", "max"):
            for i, left in enumerate(arguments):
                self.kinks += [self.combined(np.subtract, left, right) for right in arguments[i + 1 :]]
            reduce = np.minimum if name == "min" else np.maximum
            return lambda x: self.folded(reduce, [a(x) for a in arguments])
        if name in ("sum", "avg"):
            divisor = len(arguments) if name == "avg" else 1
            return lambda x: self.folded(np.add, [a(x) for a in arguments]) / divisor
        if name == "rint":
            self.kinks.append(lambda x: np.cos(np.pi * first(x)))
        return self.applied(FUNCTIONS[name], arguments)

    @staticmethod
    def applied(function, arguments):
        return lambda x: function(*(a(x) for a in arguments))

    @staticmethod
    def folded(function, values):
        result = values[0]
        for value in values[1:]:
            result = function(result, value)
        return result

"""Laws of one's own: functions over all elements at once, or a formula that is differentiated."""
from __future__ import annotations

import re
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._elamin import Law
from ._errors import InputError
from ._particles import one_or_each, real_numbers

Floats = NDArray[np.float64]
Function = Callable[[Floats], Any]


def from_functions(name: str, elements: ArrayLike, value: Function, gradient: Function, hessian: Function,
                   translation_invariant: bool) -> Law:
    def derivatives(x: Floats, with_hessian: bool) -> Tuple[Floats, Floats, Optional[Floats]]:
        return np.asarray(value(x)), np.asarray(gradient(x)), np.asarray(hessian(x)) if with_hessian else None

    return Law(name, np.asarray(elements, dtype=np.int32), not translation_invariant, lambda x: np.asarray(value(x)), derivatives)


class _Variable:
    """What a formula may name: its value, gradient (m, 3s) and Hessian (m, 3s, 3s) for positions (m, s, 3)."""

    def __init__(self, kind: str, sites: Tuple[int, ...], axis: int = 0) -> None:
        self.kind, self.sites, self.axis = kind, sites, axis

    def at(self, x: Floats, order: int) -> Tuple[Floats, Floats, Floats]:
        m, s, _ = x.shape
        grad = np.zeros((m, s, 3)) if order > 0 else np.empty(0)
        hess = np.zeros((m, s, 3, s, 3)) if order > 1 else np.empty(0)
        if self.kind == "x":
            if order > 0:
                grad[:, self.sites[0], self.axis] = 1
            return x[:, self.sites[0], self.axis], grad, hess
        if self.kind == "r":
            i, j = self.sites
            d = x[:, j] - x[:, i]
            r = np.linalg.norm(d, axis=1)
            if order > 0:
                u = d / r[:, None]
                grad[:, j], grad[:, i] = u, -u
                if order > 1:
                    h = (np.eye(3) - u[:, :, None] * u[:, None, :]) / r[:, None, None]
                    for p, of_p in ((i, -1), (j, 1)):
                        for q, of_q in ((i, -1), (j, 1)):
                            hess[:, p, :, q, :] = of_p * of_q * h
            return r, grad, hess
        i, j, k = self.sites                                   # the cosine of the angle at j
        a, b = x[:, i] - x[:, j], x[:, k] - x[:, j]
        ra, rb = np.linalg.norm(a, axis=1)[:, None], np.linalg.norm(b, axis=1)[:, None]
        u, v = a / ra, b / rb
        c = (u * v).sum(axis=1)
        if order > 0:
            gi, gk = (v - c[:, None] * u) / ra, (u - c[:, None] * v) / rb
            grad[:, i], grad[:, k], grad[:, j] = gi, gk, -(gi + gk)
        if order > 1:
            def outer(p: Floats, q: Floats) -> Floats:
                return p[:, :, None] * q[:, None, :]

            e, cc, ra2, rb2 = np.eye(3), c[:, None, None], ra[:, :, None], rb[:, :, None]
            ii = (3 * cc * outer(u, u) - cc * e - outer(u, v) - outer(v, u)) / ra2**2
            kk = (3 * cc * outer(v, v) - cc * e - outer(u, v) - outer(v, u)) / rb2**2
            ik = (e - outer(u, u) - outer(v, v) + cc * outer(u, v)) / (ra2 * rb2)
            ki = np.transpose(ik, (0, 2, 1))
            blocks = {(i, i): ii, (k, k): kk, (i, k): ik, (k, i): ki, (i, j): -(ii + ik), (k, j): -(ki + kk), (j, i): -(ii + ki),
                      (j, k): -(ik + kk), (j, j): ii + ik + ki + kk}
            for (p, q), block in blocks.items():
                hess[:, p, :, q, :] = block
        return c, grad, hess


def _variables(sites: int) -> Dict[str, _Variable]:
    """By their names. Of 12 sites c0111 is the cosine at site 1 and at site 11, and stands for none."""
    known: Dict[str, _Variable] = {}
    unclear = set()
    for i in range(sites):
        for axis, letter in enumerate("xyz"):
            known[f"{letter}{i}"] = _Variable("x", (i,), axis)
        for j in range(sites):
            if i < j:
                known[f"r{i}{j}"] = _Variable("r", (i, j))
            for k in range(sites):
                if i < k and j not in (i, k):
                    name = f"c{i}{j}{k}"
                    if name in known:
                        unclear.add(name)
                    known[name] = _Variable("c", (i, j, k))
    return {name: variable for name, variable in known.items() if name not in unclear}


def _branches(sympy: Any, expression: Any) -> Any:
    """The same with Max, Min, |a| and steps as Piecewise, whose derivative is that of the branch: without sympy's δ at the kinks.

    A term of a few of them becomes one Piecewise, so that a branch that is not taken is not computed with: the slope of √Max(a, 0) is 0/0
    where a < 0.
    """
    terms = sympy.Add.make_args(expression.rewrite(sympy.Piecewise))
    return sympy.Add(*(sympy.piecewise_fold(t) if t.count(sympy.Piecewise) <= 3 else t for t in terms))


def from_formula(name: str, elements: ArrayLike, formula: str, parameters: Mapping[str, ArrayLike]) -> Law:
    """A law from a formula in the sites' distances r01, cosines of angles c012 (at the middle site), coordinates x0, y0, z0."""
    try:
        import sympy
    except ImportError as error:
        raise InputError("a formula is differentiated by sympy, which is not installed (Debian: python3-sympy); "
                         "give functions instead") from error
    at = np.asarray(elements)
    if at.ndim != 2:
        raise InputError(f"law {name}: elements must have the shape (m, sites), has {at.shape}")
    m, sites = at.shape
    known = _variables(sites)
    formula = str(formula)                                 # of sympy, too
    words = set(re.findall(r"[A-Za-z_]\w*", re.sub(r"\d+\.?\d*[eE][+-]?\d+", "", formula)))
    for parameter in parameters:
        if parameter in known:
            raise InputError(f"law {name}: {parameter} is a variable of the formula; give the parameter another name")
    # With names that no function of numpy's has, and none of the intermediate results t0, t1, … below.
    symbols = {word: sympy.Symbol("_" + word, real=True, positive=True if word in known and known[word].kind == "r" else None)
               for word in [*known, *parameters]}
    functions = {f: getattr(sympy, f) for f in ("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh",
                                                 "pi", "Piecewise", "Max", "Min", "Heaviside")}
    functions["Abs"] = functions["abs"] = lambda a: sympy.Max(a, -a)
    unknown = sorted(words - set(symbols) - set(functions) - {"True"})
    if unknown:
        allowed = ", ".join([*known, *parameters])
        raise InputError(f"law {name}: the formula has {', '.join(unknown)}; allowed: {allowed}, and the functions {', '.join(functions)}")
    try:
        expression = sympy.sympify(formula, locals={**functions, **symbols})
    except Exception as error:                             # sympy's parser lets Python's errors of all kinds through
        why = getattr(error, "base_exc", None) or error
        raise InputError(f"law {name}: the formula {formula!r} cannot be read: {why}") from error
    if not isinstance(expression, sympy.Expr) or expression.has(sympy.I, sympy.zoo, sympy.oo, -sympy.oo, sympy.nan):
        raise InputError(f"law {name}: the formula {formula!r} is no real number; it must be an energy")
    given = [one_or_each(a, m, f"law {name}: {parameter}") for parameter, a in parameters.items()]
    for parameter, a in zip(parameters, given):
        if np.isnan(a).any():
            raise InputError(f"law {name}: {parameter}: must be numbers, is nan")
    written, expression = expression, _branches(sympy, expression)
    used = [v for v in known if symbols[v] in expression.free_symbols]
    arguments = [symbols[v] for v in [*used, *parameters]]

    def numeric(e: Any) -> Callable[[List[Floats]], Floats]:
        f = sympy.lambdify(arguments, e, modules="numpy", cse=lambda whole: sympy.cse(whole, sympy.numbered_symbols("t"), list=False))
        return lambda values: np.broadcast_to(np.asarray(f(*values), dtype=float), (m,))

    value_of = numeric(expression)
    slopes_in = [sympy.diff(expression, symbols[v]) for v in used]
    if any(slope.has(sympy.Derivative) for slope in slopes_in):
        raise InputError(f"law {name}: sympy has no derivative of the formula {formula!r}; allowed are +, -, *, /, ** and the functions "
                         f"{', '.join(functions)}")
    allowed_here = {"Abs", *(f.__name__ for f in functions.values() if isinstance(f, type))}
    other = sorted({str(f.func) for f in written.atoms(sympy.Function)} - allowed_here)
    if other:
        raise InputError(f"law {name}: the formula {formula!r} has {', '.join(other)}; allowed are the functions {', '.join(functions)}")
    first = [numeric(slope) for slope in slopes_in]
    second = [[numeric(sympy.diff(slope, symbols[w])) for w in used[:k + 1]] for k, slope in enumerate(slopes_in)]

    def value(x: Floats) -> Floats:
        with np.errstate(all="ignore"):
            return np.asarray(value_of([*(known[v].at(x, 0)[0] for v in used), *given]))

    def derivatives(x: Floats, with_hessian: bool) -> Tuple[Floats, Floats, Optional[Floats]]:
        with np.errstate(all="ignore"):
            at_x = [known[v].at(x, 2 if with_hessian else 1) for v in used]
            values = [*(a[0] for a in at_x), *given]
            n = 3 * sites
            slopes = [f(values) for f in first]
            gradient = np.zeros((m, n))
            for slope, a in zip(slopes, at_x):
                gradient += slope[:, None] * a[1].reshape(m, n)
            if not with_hessian:
                return np.asarray(value_of(values)), gradient, None
            hessian = np.zeros((m, n, n))
            for k, (slope, a) in enumerate(zip(slopes, at_x)):
                hessian += slope[:, None, None] * a[2].reshape(m, n, n)
                for other in range(k + 1):
                    curve = second[k][other](values)[:, None, None]
                    one, two = a[1].reshape(m, n), at_x[other][1].reshape(m, n)
                    part = curve * one[:, :, None] * two[:, None, :]
                    hessian += part if other == k else part + np.transpose(part, (0, 2, 1))
            return np.asarray(value_of(values)), gradient, hessian

    anchored = any(known[v].kind == "x" for v in used)
    return Law(name, at, anchored, value, derivatives)


def check_law(value: Function, gradient: Function, hessian: Function, x: ArrayLike, step: Optional[float] = None) -> Tuple[float, float]:
    """How far the derivatives of a law of one's own are from differences of its value and gradient.

    Args:
        value, gradient, hessian: its functions, as for Problem.law.
        x: positions (m, sites, 3) at which it is looked at [length].
        step: of the central differences [length]; by default 1e-5 of the largest distance between an element's sites, or of the
            coordinates.

    Returns:
        The largest deviations of gradient and Hessian, each relative to the largest entry. About 1e-9 where they are right.
    """
    x = real_numbers(x, "check_law: x")
    if x.ndim != 3 or x.shape[2] != 3 or x.size == 0:
        raise InputError(f"check_law: x must have the shape (m, sites, 3), has {x.shape}")
    if not np.isfinite(x).all():
        raise InputError("check_law: x must be finite")
    if step is not None and not (np.isfinite(step) and step > 0):
        raise InputError(f"check_law: step must be a positive number, is {step}")
    m, s, _ = x.shape

    def found(function: Function, what: str, at: Floats, *shape: int) -> Floats:
        a = np.asarray(function(at), dtype=float)
        if a.size != int(np.prod(shape)):
            raise InputError(f"check_law: the {what} must have the shape {shape}, has {a.shape}")
        return a.reshape(shape)

    spread = np.abs(x - x[:, :1]).max() if s > 1 else np.abs(x).max()
    h = step if step is not None else 1e-5 * (spread if spread > 0 else 1.0)
    g, H = found(gradient, "gradient", x, m, s, 3).reshape(m, 3 * s), found(hessian, "Hessian", x, m, 3 * s, 3 * s)
    dg, dH = np.empty_like(g), np.empty_like(H)
    for k in range(3 * s):
        step_x = np.zeros((m, 3 * s))
        step_x[:, k] = h
        up, down = x + step_x.reshape(x.shape), x - step_x.reshape(x.shape)
        dg[:, k] = (found(value, "value", up, m) - found(value, "value", down, m)) / (2 * h)
        dH[:, :, k] = (found(gradient, "gradient", up, m, s, 3) - found(gradient, "gradient", down, m, s, 3)).reshape(m, 3 * s) / (2 * h)

    def off(a: Floats, b: Floats) -> float:
        largest = float(np.abs(b).max())
        return float(np.abs(a - b).max()) / (largest if largest > 0 else 1.0)

    return off(g, dg), off(H, dH)

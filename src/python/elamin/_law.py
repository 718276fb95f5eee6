"""Laws of one's own: functions over all elements at once, or a formula that is differentiated."""
from __future__ import annotations

import re
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._elamin import Law
from ._errors import InputError

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
    known: Dict[str, _Variable] = {}
    for i in range(sites):
        for axis, letter in enumerate("xyz"):
            known[f"{letter}{i}"] = _Variable("x", (i,), axis)
        for j in range(sites):
            if i < j:
                known[f"r{i}{j}"] = _Variable("r", (i, j))
            for k in range(sites):
                if i < k and j not in (i, k):
                    known[f"c{i}{j}{k}"] = _Variable("c", (i, j, k))
    return known


def from_formula(name: str, elements: ArrayLike, formula: str, parameters: Mapping[str, ArrayLike]) -> Law:
    """A law from a formula in the sites' distances r01, cosines of angles c012 (at the middle site), coordinates x0, y0, z0."""
    try:
        import sympy
    except ImportError as error:
        raise InputError("a formula is differentiated by sympy, which is not installed (Debian: python3-sympy); "
                         "give functions instead") from error
    at = np.asarray(elements, dtype=np.int32)
    if at.ndim != 2:
        raise InputError(f"law {name}: elements must have the shape (m, sites), has {at.shape}")
    m, sites = at.shape
    known = _variables(sites)
    words = set(re.findall(r"[A-Za-z_]\w*", re.sub(r"\d+\.?\d*[eE][+-]?\d+", "", formula)))
    for parameter in parameters:
        if parameter in known:
            raise InputError(f"law {name}: {parameter} is a variable of the formula; give the parameter another name")
    symbols = {word: sympy.Symbol(word, real=True) for word in [*known, *parameters]}
    functions = {f: getattr(sympy, f) for f in ("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh",
                                                 "pi", "Piecewise", "Max", "Min", "Abs", "Heaviside")}
    functions["abs"] = sympy.Abs
    unknown = sorted(words - set(symbols) - set(functions))
    if unknown:
        allowed = ", ".join([*known, *parameters])
        raise InputError(f"law {name}: the formula has {', '.join(unknown)}; allowed: {allowed}, and the functions {', '.join(functions)}")
    try:
        expression = sympy.sympify(formula, locals={**functions, **symbols})
    except (sympy.SympifyError, TypeError, SyntaxError, AttributeError) as error:
        raise InputError(f"law {name}: the formula {formula!r} cannot be read: {error}") from error
    used = [v for v in known if symbols[v] in expression.free_symbols]
    arguments = [symbols[v] for v in [*used, *parameters]]

    def numeric(e: Any) -> Callable[[List[Floats]], Floats]:
        f = sympy.lambdify(arguments, e, modules="numpy", cse=True)
        return lambda values: np.broadcast_to(np.asarray(f(*values), dtype=float), (m,))

    value_of = numeric(expression)
    first = [numeric(sympy.diff(expression, symbols[v])) for v in used]
    second = [[numeric(sympy.diff(expression, symbols[v], symbols[w])) for w in used[:k + 1]] for k, v in enumerate(used)]
    given: List[Floats] = [np.broadcast_to(np.asarray(a, dtype=float), (m,)) for a in parameters.values()]

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
    x = np.array(x, dtype=float)
    m, s, _ = x.shape
    spread = np.abs(x - x[:, :1]).max() if s > 1 else np.abs(x).max()
    h = step if step is not None else 1e-5 * (spread if spread > 0 else 1.0)
    g, H = np.asarray(gradient(x)).reshape(m, 3 * s), np.asarray(hessian(x)).reshape(m, 3 * s, 3 * s)
    dg, dH = np.empty_like(g), np.empty_like(H)
    for k in range(3 * s):
        step_x = np.zeros((m, 3 * s))
        step_x[:, k] = h
        up, down = x + step_x.reshape(x.shape), x - step_x.reshape(x.shape)
        dg[:, k] = (np.asarray(value(up)) - np.asarray(value(down))) / (2 * h)
        dH[:, :, k] = (np.asarray(gradient(up)) - np.asarray(gradient(down))).reshape(m, 3 * s) / (2 * h)

    def off(a: Floats, b: Floats) -> float:
        largest = float(np.abs(b).max())
        return float(np.abs(a - b).max()) / (largest if largest > 0 else 1.0)

    return off(g, dg), off(H, dH)

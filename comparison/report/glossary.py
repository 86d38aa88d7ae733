"""Words of the field that a reader of the first screen may not know, explained at the pointer and the keyboard."""

import re
from collections.abc import Callable, Iterable

from markupsafe import Markup

from comparison.wording import symbols

GLOSSARY = {
    "amplification factors": "Largest absolute acceleration of a body, divided by the largest acceleration of the "
    "ground, equation (5.1).",
    "cross-verified": "Two codes that share nothing but the question agree. Whether the question describes a real "
    "building, only a measurement tells.",
    "phases": "The starting angles alpha_1 and alpha_2 of the two harmonics of the loading. One pair is one motion.",
    "phase pairs": "The starting angles alpha_1 and alpha_2 of the harmonics of the loading. One pair is one motion.",
    "independent": "Not the mirror image of another phase pair: symmetry gives the others without computing them.",
    "mean": "Sum of the differences with their signs over the phase pairs where every model has a value, divided by "
    "their number. Means of the effects add up to the mean of the total.",
    "standard deviation": "How far the differences at single phase pairs lie from their mean: root of the mean square.",
    "engine": "Exudyn, a general multibody code: spheres in hollow spheres with elastic contact, built without the "
    "paper's equations.",
    "paper's equations": "The printed equations (4.3)-(4.4) for small vibrations, with dry friction that sticks.",
    "geometry": "The whole sphere instead of its small-vibration form: equations (3.9)-(3.13).",
    "the peak at the stop": "When a sliding platform comes to rest, its acceleration jumps. The paper's largest "
    "value counts the limit just before the jump, which no computed motion reaches. This step leaves it out.",
    "regularized friction": "Friction that grows linearly with the speed below v_reg = 1 mm/s, as engines "
    "have it, instead of friction that sticks.",
    "elastic contact": "The engine's contact gives way a little; that of the equations is rigid.",
    "turning of the bodies": "Bodies may turn, overturning shifts load between the supports, and supports may lift "
    "off. The paper assumes that no body turns.",
    "two codes": "Equations and engine, given the same geometry and the same friction law: what remains is the "
    "error of the codes.",
    "real": "Larger than five times the error estimates of both models together, and so known to a fifth of itself.",
    "not real": "Not larger than five times the error estimates of both models together: nothing is claimed of it.",
    "limits": "Largest values that a scene file states as acceptable.",
}  # fmt: skip
LEAD = re.compile(r"^.*?(?= \(|\. |\.$)|\bCause(?: of the \w+)?: [^.]*(?:\.|$)")  # of a headline: how much, and why
WORDS = re.compile("|".join(rf"\b{re.escape(word)}\b" for word in sorted(GLOSSARY, key=len, reverse=True)))


def term(word: str, text: str = "") -> Markup:
    """`text`, or the word itself, with the explanation of the word at the pointer and the keyboard."""
    explanation = GLOSSARY.get(word)
    shown = symbols(text or word)
    if explanation is None:
        return shown
    tip = symbols(explanation).striptags()
    return Markup('<span class="term" tabindex="0" data-tip="{}">{}</span>').format(tip, shown)


def explained(sentence: str, seen: set[str] | None = None) -> Markup:
    """The sentence with every word of the glossary explained where it stands first."""
    seen = set() if seen is None else seen

    def first(word: str) -> Markup:
        known = word in seen
        seen.add(word)
        return symbols(word) if known else term(word)

    return _by_parts(WORDS.finditer(sentence), sentence, first, symbols)


def emphasized(sentence: str) -> Markup:
    """A headline with how much and why in bold, its words explained."""
    seen: set[str] = set()

    def strong(text: str) -> Markup:
        return Markup("<strong>{}</strong>").format(explained(text, seen))

    return _by_parts(LEAD.finditer(sentence), sentence, strong, lambda text: explained(text, seen))


def _by_parts(
    found: Iterable[re.Match[str]], text: str, inside: Callable[[str], Markup], outside: Callable[[str], Markup]
) -> Markup:
    """The text with what was found written by `inside`, and the rest by `outside`."""
    parts, end = [], 0
    for match in found:
        parts += [outside(text[end : match.start()]), inside(match.group())]
        end = match.end()
    return Markup("").join([*parts, outside(text[end:])])

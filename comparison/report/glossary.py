"""Glossary of terms that a reader of the first screen may not know, shown at the pointer and the keyboard."""

import re

from markupsafe import Markup

from comparison.wording import symbols

GLOSSARY = {  # terms of the report with the explanations that a reader sees under the pointer
    "as integrated": "Reading of (5.1): the largest value that an integration of the motion meets, with steps of about "
    "1 ms as the paper's. It counts rest and sliding faster than v_c = 1 mm/s. The paper integrates, so its plots can "
    "show no other.",
    "literal supremum": "Reading of (5.1): the limit just before the platform stops counts, too, however slow the "
    "motion is there. It holds for friction that sticks at no speed at all, and no integration reaches it.",
    "amplification factors": "Largest absolute acceleration of a body, divided by the largest acceleration of the "
    "ground, equation (5.1).",
    "phases": "The starting angles alpha_1 and alpha_2 of the two harmonics of the loading. One pair is one motion.",
    "mean": "Mean of the signed difference over the phases, with its error: of the numbers, and of the grid of phases.",
    "Exudyn": "A general multibody code: spheres in hollow spheres with elastic contact, built without the paper's "
    "equations. Spatial: bodies may turn. Translational: they may not.",
    "paper's equations": "The printed equations (4.3)-(4.4) for small vibrations, with dry friction that sticks.",
    "geometry": "The whole sphere instead of its small-vibration form: equations (3.9)-(3.13).",
    "regularized friction": "Friction that grows linearly with the speed below v_reg = 1 mm/s, as engines "
    "have it, instead of friction that sticks.",
    "elastic contact": "Exudyn's contact gives way a little; that of the equations is rigid.",
    "turning of the bodies": "Bodies may turn, overturning shifts load between the supports, and supports may lift "
    "off. The paper assumes that no body turns.",
    "other phases": "Exudyn is computed on fewer phases than the equations. This is what the means of the "
    "effects on their finer grids leave of the total: sampling, no effect.",
    "two codes": "Equations and Exudyn, given the same geometry and the same friction law: the largest difference "
    "over all phases. Met: within twice the errors that both state, together.",
    "validated": "Compared with a measurement and met within the uncertainties. Two codes that agree are only "
    "verified.",
    "not resolved": "Within its sampling error, or less than five times the numerical error: nothing is claimed of it.",
    "ill-conditioned": "More than 0.1 % of it depends on speeds below 1e-6 m/s.",
    "well-conditioned": "Less than 0.1 % of it depends on speeds below 1e-6 m/s.",
    "limits": "Largest values that a scene file states as acceptable.",
}  # fmt: skip
# Matches every term of the glossary, longer terms first
GLOSSARY_PATTERN = re.compile("|".join(rf"\b{re.escape(word)}\b" for word in sorted(GLOSSARY, key=len, reverse=True)))


def mark_term(word: str, text: str = "") -> Markup:
    """Return `text` ("": the word) as HTML that shows the glossary text of the word under pointer or keyboard focus."""
    explanation = GLOSSARY.get(word)
    shown = symbols(text or word)
    if explanation is None:
        return shown
    tip = symbols(explanation).striptags()
    return Markup('<span class="term" tabindex="0" data-tip="{}">{}</span>').format(tip, shown)


def explain_words(sentence: str) -> Markup:
    """Return the sentence as HTML in which every glossary word has its explanation at its first occurrence."""
    parts: list[Markup] = []
    seen, end = set(), 0
    for match in GLOSSARY_PATTERN.finditer(sentence):
        word = match.group()
        parts += [symbols(sentence[end : match.start()]), symbols(word) if word in seen else mark_term(word)]
        seen.add(word)
        end = match.end()
    return Markup("").join([*parts, symbols(sentence[end:])])

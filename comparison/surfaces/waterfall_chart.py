"""Layout of the waterfalls on the page's first screen: bars in percent of a width, all on one scale."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import isfinite

from comparison.surfaces.waterfall import WaterfallBar
from comparison.wording import word_difference

SCALE_MARGIN = 0.03  # share of the scale that is left free beyond the longest bar
MAX_TICKS = 5  # largest number of ticks of the axis


@dataclass(frozen=True)
class LinearScale:
    """Horizontal axis of a waterfall chart: the relative differences at its ends, and round values for its ticks."""

    low: float
    high: float
    ticks: tuple[float, ...]

    def at(self, size: float) -> float:
        """Return the position of a relative difference on the axis, percent of its length from the left."""
        return round(100.0 * (size - self.low) / (self.high - self.low), 3)


@dataclass(frozen=True)
class ChartBar:
    """One bar of the chart, with positions in percent of the width."""

    model: str  # key of the model that adds the bar's effect, or "total"
    kind: str  # "up", "down", "total", "unresolved" (not beyond its error) or "none" (no value)
    left: float
    width: float
    error: tuple[float, float]  # positions of the ends of the error bar
    end: float  # position where the next bar begins
    text: str  # text with the size and its error


def place_bars(bars: Sequence[WaterfallBar], total: WaterfallBar, scale: LinearScale) -> list[ChartBar]:
    """Return the bars of a waterfall with their positions on the axis, ready to be drawn."""
    return [_place_bar(bar, model, start, scale) for bar, model, start in _bars_with_starts(bars, total)]


def make_common_scale(waterfalls: Iterable[tuple[Sequence[WaterfallBar], WaterfallBar]]) -> LinearScale:
    """Return one axis on which all these waterfalls have room, error bars included."""
    drawn = [each for bars, total in waterfalls for each in _bars_with_starts(bars, total) if isfinite(each[0].size)]
    sizes = [0.0, *(start + bar.size + side * _finite_error(bar) for bar, _, start in drawn for side in (-1.0, 1.0))]
    low, high = min(sizes), max(sizes)
    if low == high:
        low, high = -0.01, 0.01
    room = SCALE_MARGIN * (high - low)
    low, high = low - room, high + room
    return LinearScale(low, high, tuple(_tick_values(low, high)))


@dataclass(frozen=True)
class LogScale:
    """Logarithmic axis of relative differences, with these at its ends."""

    low: float
    high: float

    def at(self, size: float) -> float:
        """Return the position of a relative difference, percent of the length; beyond an end it is at that end."""
        if not size > self.low:
            return 1.0
        return round(min(99.0, 1.0 + 98.0 * math.log(size / self.low) / math.log(self.high / self.low)), 3)

    @property
    def ticks(self) -> list[float]:
        """Return the positions of the powers of ten, percent of the length."""
        powers = range(round(math.log10(self.low)), round(math.log10(self.high)) + 1)
        return [self.at(10.0**power) for power in powers]


def make_log_scale(sizes: Iterable[float]) -> LogScale:
    """Return an axis whose powers of ten enclose all sizes above zero."""
    powers = [math.log10(size) for size in sizes if isfinite(size) and size > 0.0]
    low, high = (math.floor(min(powers)), math.ceil(max(powers))) if powers else (-4, 0)
    return LogScale(10.0**low, 10.0 ** max(high, low + 1))


def _bars_with_starts(bars: Sequence[WaterfallBar], total: WaterfallBar) -> Iterator[tuple[WaterfallBar, str, float]]:
    """Yield every bar with its model and its start: where the previous one ends, and zero for the total."""
    start = 0.0
    for bar in bars:
        yield bar, bar.model, start
        start += bar.size if isfinite(bar.size) else 0.0
    yield total, "total", 0.0


def _finite_error(bar: WaterfallBar) -> float:
    """Return the error of a bar, 0 where it is unknown."""
    return bar.error if isfinite(bar.error) else 0.0


def _place_bar(bar: WaterfallBar, model: str, start: float, scale: LinearScale) -> ChartBar:
    """Return where a bar that begins at `start` is drawn, and its kind: up, down, total, or unresolved."""
    begin = scale.at(start)
    if not isfinite(bar.size):
        return ChartBar(
            model=model, kind="none", left=begin, width=0.0, error=(begin, begin), end=begin, text="no value"
        )
    end = scale.at(start + bar.size)
    ends = scale.at(start + bar.size - _finite_error(bar)), scale.at(start + bar.size + _finite_error(bar))
    kind = "unresolved" if not bar.resolved else "total" if model == "total" else "up" if bar.size >= 0.0 else "down"
    return ChartBar(
        model=model,
        kind=kind,
        left=min(begin, end),
        width=round(abs(end - begin), 3),
        error=ends,
        end=end,
        text=word_difference(bar.size, _finite_error(bar)),
    )


def _tick_values(low: float, high: float) -> list[float]:
    """Return round values between the ends of an axis, at steps of 1, 2 or 5 times a power of ten."""
    rough = (high - low) / MAX_TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(digit * power for digit in (1.0, 2.0, 5.0, 10.0) if digit * power >= rough)
    return [number * step for number in range(math.ceil(low / step), math.floor(high / step) + 1)]

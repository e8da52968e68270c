"""The types of a point of a chart, as JSON objects: a candidate, its fitted parameters, its cost and its error.

A measured point has all keys that are not of the GPU. A point of another program's record may omit those that are not
required. Numbers that are not finite are NaN or infinity in a measured point, and None in a checked record.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NotRequired, TypedDict


class GpuTimes(TypedDict, total=False):
    """Times on a GPU, without those of the same shader without the chain."""

    gpu_ratio: float
    """The time, relative to the shader without the chain"""
    gpu_ms: float | None
    """Milliseconds per picture, the median; None if it is not timed"""
    gpu_ms_low: float
    """The 10th percentile"""
    gpu_ms_high: float
    """The 90th percentile"""


class PointCost(GpuTimes):
    """The cost of one evaluation of a chain for one light."""

    value: float
    """In the unit of the record's `cost_unit`, at least 0"""
    static: NotRequired[float]
    """Weighted operations, in a record whose `value` is another cost"""
    operations: NotRequired[int]
    transcendentals: NotRequired[int]
    fetches: NotRequired[int]
    volume_fetches: NotRequired[int]
    distance_evaluations: NotRequired[int]
    once: NotRequired[dict[str, int]]
    """Of a material: the part of these four counts that is the same for any number of lights"""


class ViewError(TypedDict):
    """The relative error on one view."""

    value: float | None
    low: NotRequired[float | None]
    """Two standard errors below `value`"""
    high: NotRequired[float | None]
    """Two standard errors above `value`"""


class PointError(ViewError):
    """The error over all views; see `error_metric.compare`."""

    relmse: NotRequired[float | None]
    bias: NotRequired[float | None]
    p99: NotRequired[float | None]
    max: NotRequired[float | None]
    flip: NotRequired[float]
    """The mean of FLIP's map, 0 to 1; only of materials"""


class FittedChain(TypedDict):
    """A candidate with its fitted parameters."""

    role: str
    name: str
    label: str
    baseline: NotRequired[bool]
    """Whether it is published, and not ours"""
    settings: NotRequired[dict[str, int]]
    """The counts of the chain"""
    chain: NotRequired[list[str]]
    """The techniques, in order"""
    path: NotRequired[str]
    """The function of the length inside the body; '' without one"""
    path_settings: NotRequired[dict[str, int]]
    """The counts of `path`"""
    parameters: NotRequired[dict[str, list[float]]]
    """The components of the fitted parameters"""
    scale: NotRequired[list[float]]
    """The factor of the chain's output, per channel"""
    matte: NotRequired[list[float]]
    """The factor of the Lambert reflection, per channel"""
    factor: NotRequired[str]
    """The parameter that `scale` multiplies; '' without one"""
    training_error: NotRequired[float]
    """The relative error on the training views; NaN if nothing is fitted"""


class MeasuredPoint(FittedChain):
    """A chain that is measured on the views of one scene."""

    requires: NotRequired[list[str]]
    """Of `material.attributes.REQUIREMENTS`"""
    bytes: NotRequired[int]
    """The bytes of the chain's baked textures"""
    cost: PointCost
    error: PointError
    views: NotRequired[dict[str, ViewError]]
    views_at: NotRequired[dict[str, dict[str, ViewError]]]
    """Rows of pixels in which the screen shows a view → its views, at that size"""
    implementation: NotRequired[Mapping[str, float | None]]
    """The relative errors of float32 and of finite counts, without the error of the model"""
    failed: NotRequired[str]
    """Why the point failed; '' if it has not"""
    front: NotRequired[bool]
    """In a record: whether the point is on the Pareto front of its scene and role"""

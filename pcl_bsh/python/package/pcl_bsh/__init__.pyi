# SPDX-License-Identifier: BSD-3-Clause
import enum
import os
from typing import Any, Callable, Dict, Iterator, List, Literal, Mapping, Optional, Sequence, Tuple, Union, overload

import numpy as np
import numpy.typing as npt

__version__: str
__all__: List[str]

_Floats32 = npt.NDArray[np.float32]
_Floats64 = npt.NDArray[np.float64]
_Records = npt.NDArray[np.uint32]
_Indices = npt.NDArray[np.int32]
_Flags = npt.NDArray[np.uint8]
_Structured = npt.NDArray[np.void]
_Pose = Optional[npt.ArrayLike]
_AccuracyLike = Optional[Union[str, Accuracy]]
_Progress = Optional[Callable[[float], Any]]
_Path = Union[str, os.PathLike[str]]
_Motion = Optional[Union[VelocityMotion, CircularMotion, WaypointMotion]]
_Object = Union[int, str]
_Part = Union[Tuple[str, SphereHierarchy], Tuple[str, SphereHierarchy, npt.ArrayLike]]

NO_POINT: int

class Verdict(enum.IntEnum):
    FREE = 0
    COLLIDING = 1
    UNDECIDED = 2
    SPARSE = 3

class Cancelled(RuntimeError): ...
class FileError(OSError, ValueError): ...
class PipelineError(ValueError): ...

class Accuracy:
    def __init__(self, text: str = ...) -> None: ...
    @staticmethod
    def exact() -> Accuracy: ...
    @staticmethod
    def float_only() -> Accuracy: ...
    @staticmethod
    def tolerance(length: float) -> Accuracy: ...
    @staticmethod
    def level(depth: int) -> Accuracy: ...
    @staticmethod
    def node_pairs(count: int) -> Accuracy: ...
    @staticmethod
    def time(seconds: float) -> Accuracy: ...
    @property
    def is_exact(self) -> bool: ...
    @property
    def stops_early(self) -> bool: ...
    @property
    def is_proven(self) -> bool: ...
    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...

class Work:
    @property
    def node_pairs(self) -> int: ...
    @property
    def volumes_carried(self) -> int: ...
    @property
    def volumes_built(self) -> int: ...
    @property
    def voxels_built(self) -> int: ...
    @property
    def leaf_pairs(self) -> int: ...
    @property
    def exact_decisions(self) -> int: ...
    @property
    def updates(self) -> int: ...

class SphereHierarchy:
    def __init__(
        self,
        xyz: npt.ArrayLike,
        *,
        radii: Optional[npt.ArrayLike] = ...,
        indices: Optional[npt.ArrayLike] = ...,
        uncertainty: float = ...,
        uncertainties: Optional[npt.ArrayLike] = ...,
        copy: bool = ...,
        voxel_edge: float = ...,
        threads: int = ...,
    ) -> None: ...
    def __len__(self) -> int: ...
    @property
    def array(self) -> Optional[npt.NDArray[Any]]: ...
    @property
    def in_place(self) -> bool: ...
    @property
    def records(self) -> int: ...
    @property
    def coordinate_spacing(self) -> float: ...
    def build_all(self, threads: int = ...) -> None: ...
    def refit(
        self,
        xyz: npt.ArrayLike,
        *,
        radii: Optional[npt.ArrayLike] = ...,
        uncertainties: Optional[npt.ArrayLike] = ...,
        copy: bool = ...,
        most_growth: float = ...,
    ) -> Dict[str, Any]: ...
    def validate(self) -> List[str]: ...
    def statistics(self) -> Dict[str, Any]: ...

class AnyCollision:
    @property
    def verdict(self) -> Verdict: ...
    @property
    def witness(self) -> Optional[Tuple[int, int]]: ...
    @property
    def interval(self) -> Tuple[float, float]: ...
    @property
    def work(self) -> Work: ...
    def __bool__(self) -> bool: ...

class ClosestPair:
    @property
    def distance(self) -> float: ...
    @property
    def a(self) -> Optional[int]: ...
    @property
    def b(self) -> Optional[int]: ...
    @property
    def interval(self) -> Tuple[float, float]: ...
    @property
    def work(self) -> Work: ...

class Contacts:
    @property
    def a(self) -> _Records: ...
    @property
    def b(self) -> _Records: ...
    @property
    def distance(self) -> _Floats64: ...
    @property
    def normal(self) -> _Floats64: ...
    @property
    def complete(self) -> bool: ...
    @property
    def work(self) -> Work: ...
    def __len__(self) -> int: ...

class PointDistances:
    @property
    def distance(self) -> _Floats64: ...
    @property
    def nearest(self) -> _Records: ...
    @property
    def interval(self) -> Optional[_Floats64]: ...
    @property
    def measured(self) -> int: ...
    @property
    def undecided(self) -> int: ...
    @property
    def greatest(self) -> float: ...
    @property
    def greatest_pair(self) -> Optional[Tuple[int, int]]: ...
    @property
    def work(self) -> Work: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Any]: ...

class SymmetricDistances:
    @property
    def a(self) -> PointDistances: ...
    @property
    def b(self) -> PointDistances: ...
    @property
    def hausdorff(self) -> float: ...
    @property
    def hausdorff_pair(self) -> Optional[Tuple[int, int]]: ...

class HausdorffDistance:
    @property
    def distance(self) -> float: ...
    @property
    def pair(self) -> Optional[Tuple[int, int]]: ...
    @property
    def work(self) -> Work: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Any]: ...

class Trajectory:
    @property
    def flags(self) -> Optional[_Flags]: ...
    @property
    def distance(self) -> Optional[_Floats32]: ...
    @property
    def first_pose(self) -> Optional[_Indices]: ...
    @property
    def closest_pose(self) -> Optional[_Indices]: ...
    @property
    def closest_point(self) -> Optional[_Records]: ...
    @property
    def certain_pose(self) -> Optional[_Indices]: ...
    @property
    def poses(self) -> Optional[_Structured]: ...
    @property
    def colliding(self) -> int: ...
    @property
    def undecided(self) -> int: ...
    @property
    def first_contact(self) -> Optional[Tuple[int, float]]: ...
    @property
    def certain_contact(self) -> Optional[Tuple[int, float]]: ...
    @property
    def work(self) -> Work: ...

class Clash:
    @property
    def id(self) -> str: ...
    @property
    def status(self) -> Literal["new", "persisting", "resolved"]: ...
    @property
    def records(self) -> _Records: ...
    @property
    def points(self) -> int: ...
    @property
    def certain_points(self) -> int: ...
    @property
    def low(self) -> List[float]: ...
    @property
    def high(self) -> List[float]: ...
    @property
    def distance(self) -> float: ...
    @property
    def scan_point(self) -> int: ...
    @property
    def model_point(self) -> int: ...
    @property
    def first_pose(self) -> int: ...
    @property
    def closest_pose(self) -> int: ...

class Neighbors:
    @property
    def offsets(self) -> npt.NDArray[np.int64]: ...
    @property
    def indices(self) -> _Indices: ...
    @property
    def squared_distances(self) -> _Floats32: ...
    def __len__(self) -> int: ...
    def __getitem__(self, i: int) -> Tuple[_Indices, _Floats32]: ...

class Clusters:
    @property
    def of(self) -> _Indices: ...
    @property
    def sizes(self) -> npt.NDArray[np.uint64]: ...
    @property
    def work(self) -> Work: ...
    def __len__(self) -> int: ...

class SurfaceCover:
    @property
    def centers(self) -> _Floats64: ...
    @property
    def radii(self) -> _Floats32: ...
    @property
    def triangles(self) -> _Records: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def area(self) -> float: ...
    def hierarchy(self, *, threads: int = ...) -> SphereHierarchy: ...
    def __len__(self) -> int: ...

class VelocityMotion:
    def __init__(self, linear: npt.ArrayLike, angular: Optional[npt.ArrayLike] = ...) -> None: ...

class CircularMotion:
    def __init__(self, center: npt.ArrayLike, axis: npt.ArrayLike, speed: float, turning: bool = ...) -> None: ...

class WaypointMotion:
    def __init__(self, times: Sequence[float], poses: npt.ArrayLike) -> None: ...

class SceneResult:
    @property
    def time(self) -> float: ...
    @property
    def any(self) -> List[Dict[str, Any]]: ...
    @property
    def undecided(self) -> List[Dict[str, Any]]: ...
    @property
    def flags(self) -> List[Dict[str, Any]]: ...
    @property
    def distance(self) -> List[Dict[str, Any]]: ...
    @property
    def contacts(self) -> List[Dict[str, Any]]: ...
    @property
    def first_contact(self) -> List[Dict[str, Any]]: ...
    @property
    def certain_contact(self) -> List[Dict[str, Any]]: ...
    @property
    def swept(self) -> List[Dict[str, Any]]: ...
    @property
    def swept_motions(self) -> List[Dict[str, Any]]: ...
    @property
    def unswept(self) -> List[Dict[str, Any]]: ...
    @property
    def self_collisions(self) -> List[Dict[str, Any]]: ...
    @property
    def outcomes(self) -> List[Dict[str, Any]]: ...

class Scene:
    def __init__(
        self,
        *,
        clearance: float = ...,
        any: bool = ...,
        flags: bool = ...,
        distance: Optional[float] = ...,
        contacts: Optional[int] = ...,
        first_contact: bool = ...,
        swept: bool = ...,
        self_collisions: bool = ...,
        response: Literal["none", "stop", "slide"] = ...,
        gravity: Optional[float] = ...,
        down: Optional[npt.ArrayLike] = ...,
        test_pairs: bool = ...,
        accuracy: _AccuracyLike = ...,
        tolerance: float = ...,
        voxel_edge: float = ...,
        threads: int = ...,
        deform: Optional[float] = ...,
    ) -> None: ...
    def add(
        self,
        name: str,
        cloud: Union[SphereHierarchy, Sequence[_Part]],
        pose: _Pose = ...,
        *,
        fixed: bool = ...,
        group: str = ...,
        motion: _Motion = ...,
        adjacent: Sequence[Tuple[int, int]] = ...,
    ) -> int: ...
    def __len__(self) -> int: ...
    @property
    def time(self) -> float: ...
    def find(self, name: str) -> Optional[int]: ...
    def pose(self, object: _Object) -> _Floats64: ...
    def set_pose(self, object: _Object, pose: npt.ArrayLike) -> None: ...
    def set_part_pose(self, object: _Object, part: int, pose: npt.ArrayLike) -> None: ...
    def deform(
        self,
        object: _Object,
        xyz: npt.ArrayLike,
        part: int = ...,
        *,
        radii: Optional[npt.ArrayLike] = ...,
        uncertainties: Optional[npt.ArrayLike] = ...,
        copy: bool = ...,
    ) -> Dict[str, Any]: ...
    def set_motion(self, object: _Object, motion: _Motion) -> None: ...
    def set_rule(
        self, a: _Object, b: _Object, *, tested: Optional[bool] = ..., clearance: Optional[float] = ...
    ) -> None: ...
    def set_group_rule(
        self, a: str, b: str, *, tested: Optional[bool] = ..., clearance: Optional[float] = ...
    ) -> None: ...
    def query(self) -> SceneResult: ...
    def step(self, dt: float) -> SceneResult: ...

class FileHeader:
    @property
    def viewpoint(self) -> Tuple[float, ...]: ...
    @property
    def coordinate_system(self) -> str: ...
    @property
    def is_las(self) -> bool: ...

class PipelineRun:
    @property
    def clouds(self) -> Dict[str, _Structured]: ...
    @property
    def warnings(self) -> List[str]: ...
    @property
    def metadata(self) -> Dict[str, Any]: ...

@overload
def collision_flags(
    a: SphereHierarchy,
    b: SphereHierarchy,
    clearance: float = ...,
    *,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
    side: Literal["a", "b"] = ...,
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
    spacings_of_b: Optional[_Floats32] = ...,
) -> _Flags: ...
@overload
def collision_flags(
    a: SphereHierarchy,
    b: SphereHierarchy,
    clearance: float = ...,
    *,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
    side: Literal["both"],
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
    spacings_of_b: Optional[_Floats32] = ...,
) -> Tuple[_Flags, _Flags]: ...
@overload
def colliding_indices(
    a: SphereHierarchy,
    b: SphereHierarchy,
    clearance: float = ...,
    *,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
    side: Literal["a", "b"] = ...,
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
) -> _Indices: ...
@overload
def colliding_indices(
    a: SphereHierarchy,
    b: SphereHierarchy,
    clearance: float = ...,
    *,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
    side: Literal["both"],
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
) -> Tuple[_Indices, _Indices]: ...
def any_collision(
    a: SphereHierarchy,
    b: SphereHierarchy,
    clearance: float = ...,
    *,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
) -> AnyCollision: ...
def closest_pair(
    a: SphereHierarchy,
    b: SphereHierarchy,
    *,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
) -> ClosestPair: ...
def contacts(
    a: SphereHierarchy,
    b: SphereHierarchy,
    clearance: float = ...,
    *,
    most: Optional[int] = ...,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
) -> Contacts: ...
def pairs_within(
    a: SphereHierarchy,
    b: SphereHierarchy,
    clearance: float = ...,
    *,
    most: Optional[int] = ...,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
) -> _Records: ...
def point_distances(
    a: SphereHierarchy,
    b: SphereHierarchy,
    max_distance: Optional[float] = ...,
    *,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> PointDistances: ...
def symmetric_distances(
    a: SphereHierarchy,
    b: SphereHierarchy,
    max_distance: Optional[float] = ...,
    *,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> SymmetricDistances: ...
def hausdorff_distance(
    a: SphereHierarchy,
    b: SphereHierarchy,
    *,
    pose_a: _Pose = ...,
    pose_b: _Pose = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> HausdorffDistance: ...
@overload
def radius_search(
    cloud: SphereHierarchy,
    queries: npt.NDArray[Any],
    radius: float,
    *,
    most: int = ...,
    sorted: bool = ...,
    threads: int = ...,
) -> Any: ...
@overload
def radius_search(
    cloud: SphereHierarchy,
    queries: Sequence[float],
    radius: float,
    *,
    most: int = ...,
    sorted: bool = ...,
    threads: int = ...,
) -> Tuple[_Indices, _Floats32]: ...
@overload
def nearest_k_search(cloud: SphereHierarchy, queries: npt.NDArray[Any], k: int, *, threads: int = ...) -> Any: ...
@overload
def nearest_k_search(
    cloud: SphereHierarchy, queries: Sequence[float], k: int, *, threads: int = ...
) -> Tuple[_Indices, _Floats32]: ...
@overload
def any_in_radius(
    cloud: SphereHierarchy, queries: npt.NDArray[Any], radius: float, *, threads: int = ...
) -> Any: ...
@overload
def any_in_radius(cloud: SphereHierarchy, queries: Sequence[float], radius: float, *, threads: int = ...) -> bool: ...
def box_search(cloud: SphereHierarchy, low: npt.ArrayLike, high: npt.ArrayLike) -> _Indices: ...
def euclidean_clusters(cloud: SphereHierarchy, distance: float) -> Clusters: ...
def spacing_of(cloud: SphereHierarchy) -> Dict[str, Any]: ...
def patch_spacings(cloud: SphereHierarchy, widest_gap: Optional[float] = ..., *, threads: int = ...) -> _Floats32: ...
def collide_along(
    scan: SphereHierarchy,
    model: SphereHierarchy,
    poses: npt.ArrayLike,
    clearance: float = ...,
    *,
    pose_scan: _Pose = ...,
    flags: bool = ...,
    distances: bool = ...,
    first_poses: bool = ...,
    closest_poses: bool = ...,
    pose_summaries: bool = ...,
    swept: Optional[float] = ...,
    pivot: Optional[npt.ArrayLike] = ...,
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> Trajectory: ...
def pose_between(
    start: npt.ArrayLike, end: npt.ArrayLike, fraction: float, pivot: Optional[npt.ArrayLike] = ...
) -> _Floats64: ...
def find_clashes(scan: SphereHierarchy, run: Trajectory, cluster_distance: float) -> List[Clash]: ...
def compare_with_earlier(clashes: Sequence[Clash], earlier: Sequence[Clash], nearness: float) -> List[Clash]: ...
def any_collision_at_poses(
    a: SphereHierarchy,
    b: SphereHierarchy,
    poses: npt.ArrayLike,
    clearance: float = ...,
    *,
    pose_a: _Pose = ...,
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> _Flags: ...
def closest_pair_at_poses(
    a: SphereHierarchy,
    b: SphereHierarchy,
    poses: npt.ArrayLike,
    *,
    pose_a: _Pose = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> Tuple[_Floats64, _Records]: ...
def collision_flags_at_poses(
    a: SphereHierarchy,
    b: SphereHierarchy,
    poses: npt.ArrayLike,
    clearance: float = ...,
    *,
    pose_a: _Pose = ...,
    accuracy: _AccuracyLike = ...,
    threads: int = ...,
) -> _Flags: ...
def any_collision_on_motions(
    scan: SphereHierarchy,
    model: SphereHierarchy,
    poses: npt.ArrayLike,
    motions: npt.ArrayLike,
    clearance: float = ...,
    *,
    tolerance: float,
    pose_scan: _Pose = ...,
    pivot: Optional[npt.ArrayLike] = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> _Flags: ...
def cover_surface(
    vertices: npt.ArrayLike,
    triangles: npt.ArrayLike,
    tolerance: float,
    *,
    triangles_apart: bool = ...,
    progress: _Progress = ...,
) -> SurfaceCover: ...
def read(path: _Path, columns: Optional[Sequence[str]] = ...) -> _Structured: ...
def read_with_header(path: _Path, columns: Optional[Sequence[str]] = ...) -> Tuple[_Structured, FileHeader]: ...
def read_mesh(path: _Path) -> Tuple[_Structured, _Records]: ...
def write(path: _Path, records: npt.NDArray[Any], header: Optional[FileHeader] = ...) -> None: ...
def run_pipeline(
    document: Union[str, Mapping[str, Any], Sequence[Any]],
    clouds: Optional[Mapping[str, npt.NDArray[Any]]] = ...,
    *,
    threads: int = ...,
    validate_only: bool = ...,
    progress: Optional[Callable[[Dict[str, Any]], Any]] = ...,
) -> PipelineRun: ...

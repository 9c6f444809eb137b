"""habitat-sim's `.navmesh` files: a reader that trusts no byte, and Detour's queries on them.

A file holds tiles of convex polygons; `file` and `tile` parse them, `links` joins them, `arrays`
lays them out, `nearest`, `corridor`, `funnel` and `slide` walk them, and `mesh` is the `Surface`.
"""

from c2nav_engine.world.navmesh.field import NavMeshField
from c2nav_engine.world.navmesh.islands import Island
from c2nav_engine.world.navmesh.mesh import NavMesh, profile_note, read_navmesh
from c2nav_engine.world.navmesh.pairs import query_pairs
from c2nav_engine.world.navmesh.settings import NavMeshSettings

__all__ = [
    "Island",
    "NavMesh",
    "NavMeshField",
    "NavMeshSettings",
    "profile_note",
    "query_pairs",
    "read_navmesh",
]

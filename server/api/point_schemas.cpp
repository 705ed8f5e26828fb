#include "server/api/openapi_schemas.hpp"

namespace stipple::server {

const std::string_view pointSchemas = R"json({
"Hierarchy": {
    "type": "object",
    "required": ["id", "version", "key", "attributeBlocks", "nodes"],
    "properties": {
        "id": {"type": "string"},
        "version": {"$ref": "#/components/schemas/Version"},
        "key": {"$ref": "#/components/schemas/NodeKey"},
        "attributeBlocks": {
            "description": "Names of the attributes in each block of a node, behind its strata",
            "type": "array",
            "items": {"type": "array", "items": {"type": "string"}}
        },
        "nodes": {
            "description": "Breadth first",
            "type": "array",
            "minItems": 1,
            "items": {"$ref": "#/components/schemas/Node"}
        }
    },
    "additionalProperties": false
},
"Node": {
    "type": "object",
    "required": ["key", "childMask", "pointCount", "bounds", "spacing", "offset", "strataBytes", "attributeBytes",
                 "childChunk"],
    "properties": {
        "key": {"$ref": "#/components/schemas/NodeKey"},
        "childMask": {"type": "integer", "minimum": 0, "maximum": 255, "description": "Bit i: it has child i"},
        "pointCount": {"type": "integer", "minimum": 0},
        "bounds": {"$ref": "#/components/schemas/Box", "description": "Its cube"},
        "spacing": {"type": "number", "description": "Of its level"},
        "offset": {"type": "integer", "minimum": 0, "description": "Of its bytes in the cloud's file"},
        "strataBytes": {"type": "array", "items": {"type": "integer", "minimum": 0}, "minItems": 4, "maxItems": 4},
        "attributeBytes": {"type": "array", "items": {"type": "integer", "minimum": 0}},
        "childChunk": {
            "description": "Where its children are described, if not in this list",
            "oneOf": [
                {"type": "null"},
                {
                    "type": "object",
                    "required": ["offset", "size"],
                    "properties": {
                        "offset": {"type": "integer", "minimum": 0},
                        "size": {"type": "integer", "minimum": 1}
                    },
                    "additionalProperties": false
                }
            ]
        }
    },
    "additionalProperties": false
},
"NodePoints": {
    "type": "object",
    "required": ["id", "version", "key", "pointCount", "strata", "columns", "points"],
    "properties": {
        "id": {"type": "string"},
        "version": {"$ref": "#/components/schemas/Version"},
        "key": {"$ref": "#/components/schemas/NodeKey"},
        "pointCount": {"type": "integer", "minimum": 0, "description": "Of the whole node"},
        "strata": {"type": "integer", "minimum": 1, "maximum": 4},
        "columns": {
            "description": "X, Y, Z, then attributes; those of several components as name[0], name[1], …",
            "type": "array",
            "minItems": 3,
            "items": {"type": "string"}
        },
        "points": {
            "description": "A value for each column; null is no value, and what is not finite",
            "type": "array",
            "items": {"type": "array", "minItems": 3, "items": {"type": ["number", "null"]}}
        }
    },
    "additionalProperties": false
},
"Statistics": {
    "type": "object",
    "required": ["id", "version", "isComputed", "pointCount", "bounds", "density", "levels", "coordinates",
                 "attributes"],
    "properties": {
        "id": {"type": "string"},
        "version": {"$ref": "#/components/schemas/Version"},
        "isComputed": {"type": "boolean", "description": "From points that were read; else told by the file"},
        "pointCount": {"type": "integer", "minimum": 0},
        "bounds": {
            "description": "Of these points; null if there are none",
            "oneOf": [{"$ref": "#/components/schemas/Box"}, {"type": "null"}]
        },
        "density": {
            "description": "Over the bounds, in plan; null if these have no area",
            "oneOf": [
                {"type": "null"},
                {
                    "type": "object",
                    "required": ["area", "pointsPerArea"],
                    "properties": {
                        "area": {"type": "number", "description": "In squares of the cloud's unit"},
                        "pointsPerArea": {"type": "number"},
                        "pointsPerSquareMeter": {"type": "number", "description": "Where the unit is known"}
                    },
                    "additionalProperties": false
                }
            ]
        },
        "levels": {
            "description": "Those that have some of these points",
            "type": "array",
            "items": {
                "type": "object",
                "required": ["level", "spacing", "nodes", "points"],
                "properties": {
                    "level": {"type": "integer", "minimum": 0},
                    "spacing": {"type": ["number", "null"]},
                    "nodes": {"type": "integer", "minimum": 1},
                    "points": {"type": "integer", "minimum": 1}
                },
                "additionalProperties": false
            }
        },
        "coordinates": {
            "description": "X, Y and Z; mean and deviation if computed",
            "type": "array", "minItems": 3, "maxItems": 3,
            "items": {"$ref": "#/components/schemas/ValueStatistics", "unevaluatedProperties": false}
        },
        "attributes": {"type": "array", "items": {"$ref": "#/components/schemas/AttributeStatistics"}},
        "classes": {
            "description": "Of the attribute Classification",
            "type": "array",
            "items": {
                "type": "object",
                "required": ["class", "name", "points"],
                "properties": {
                    "class": {"type": "integer"},
                    "name": {"type": "string", "description": "As LAS 1.4 has it"},
                    "points": {"type": "integer", "minimum": 1}
                },
                "additionalProperties": false
            }
        },
        "returns": {
            "type": "object",
            "properties": {
                "numbers": {
                    "description": "Points by Return Number",
                    "type": "array",
                    "items": {
                        "type": "object",
                        "required": ["return", "points"],
                        "properties": {"return": {"type": "integer"}, "points": {"type": "integer", "minimum": 1}},
                        "additionalProperties": false
                    }
                },
                "pulses": {
                    "description": "Points by Number of Returns",
                    "type": "array",
                    "items": {
                        "type": "object",
                        "required": ["returns", "points"],
                        "properties": {"returns": {"type": "integer"}, "points": {"type": "integer", "minimum": 1}},
                        "additionalProperties": false
                    }
                }
            },
            "additionalProperties": false
        }
    },
    "additionalProperties": false
},
"ValueStatistics": {
    "description": "Of values that stored ones mean, without \"no value\" and NaN. Null is infinite",
    "type": "object",
    "required": ["name"],
    "properties": {
        "name": {"type": "string"},
        "count": {"type": "integer", "minimum": 0, "description": "Of values, where it is known"},
        "min": {"type": ["number", "null"]},
        "max": {"type": ["number", "null"]},
        "mean": {"type": ["number", "null"]},
        "deviation": {"type": ["number", "null"], "description": "Standard deviation of all of them"},
        "histogram": {
            "description": "counts[i] values lie in edges[i] <= value < edges[i + 1]; in the last interval its end, too",
            "type": "object",
            "required": ["edges", "counts"],
            "properties": {
                "edges": {"type": "array", "minItems": 2, "items": {"type": "number"}},
                "counts": {"type": "array", "minItems": 1, "items": {"type": "integer", "minimum": 0}}
            },
            "additionalProperties": false
        }
    }
},
"AttributeStatistics": {
    "$ref": "#/components/schemas/ValueStatistics",
    "type": "object",
    "required": ["type", "components", "unit"],
    "properties": {
        "type": {"$ref": "#/components/schemas/AttributeType"},
        "components": {"type": "integer", "minimum": 1, "maximum": 255},
        "unit": {"type": "string"},
        "values": {
            "description": "Every value and how many points have it, if there are at most 256",
            "type": "array",
            "items": {
                "type": "object",
                "required": ["value", "points"],
                "properties": {"value": {"type": "number"}, "points": {"type": "integer", "minimum": 1}},
                "additionalProperties": false
            }
        }
    },
    "unevaluatedProperties": false
},
"Nearest": {
    "type": "object",
    "required": ["id", "version", "points", "read"],
    "properties": {
        "id": {"type": "string"},
        "version": {"$ref": "#/components/schemas/Version"},
        "points": {"type": "array", "items": {"$ref": "#/components/schemas/NearestPoint"}},
        "read": {
            "description": "What had to be read for the answer",
            "type": "object",
            "required": ["nodes", "bytes", "points", "hierarchyChunks"],
            "properties": {
                "nodes": {"type": "integer", "minimum": 0},
                "bytes": {"type": "integer", "minimum": 0},
                "points": {"type": "integer", "minimum": 0},
                "hierarchyChunks": {"type": "integer", "minimum": 0}
            },
            "additionalProperties": false
        }
    },
    "additionalProperties": false
},
"NearestPoint": {
    "type": "object",
    "required": ["node", "index", "grid", "position", "distance", "attributes"],
    "properties": {
        "node": {"$ref": "#/components/schemas/NodeKey"},
        "index": {"type": "integer", "minimum": 0, "description": "Among the points of the node as stored"},
        "grid": {"$ref": "#/components/schemas/GridPosition"},
        "position": {"$ref": "#/components/schemas/Position"},
        "distance": {"type": "number", "minimum": 0, "description": "From the place, or from the ray"},
        "along": {"type": "number", "minimum": 0, "description": "Of rays: how far from the origin"},
        "attributes": {
            "description": "By name",
            "type": "object",
            "additionalProperties": {
                "anyOf": [
                    {"type": ["number", "null"]},
                    {"type": "array", "items": {"type": ["number", "null"]}}
                ]
            }
        }
    },
    "additionalProperties": false
}
})json";

} // namespace stipple::server

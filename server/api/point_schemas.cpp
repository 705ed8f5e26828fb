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

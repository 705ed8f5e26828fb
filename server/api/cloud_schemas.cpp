#include "server/api/openapi_schemas.hpp"

namespace stipple::server {

const std::string_view cloudSchemas = R"json({
"OpenApi": {
    "type": "object",
    "required": ["openapi", "info", "paths", "components"],
    "properties": {"openapi": {"const": "3.1.0"}}
},
"Problem": {
    "description": "RFC 9457",
    "type": "object",
    "required": ["type", "title", "status", "detail"],
    "properties": {
        "type": {"type": "string", "description": "An address that says what is meant"},
        "title": {"type": "string", "description": "The same for each problem of the type"},
        "status": {"type": "integer", "minimum": 400, "maximum": 599},
        "detail": {"type": "string", "description": "What is wrong with this request, and what to do"},
        "instance": {"type": "string", "description": "The path that was asked for"},
        "parameter": {"type": "string", "description": "The parameter that is at fault"},
        "available": {"type": "array", "items": {"type": "string"}, "description": "406: the media types there are"}
    },
    "additionalProperties": false
},
"ProblemType": {
    "type": "object",
    "required": ["type", "title", "status", "meaning"],
    "properties": {
        "type": {"type": "string"},
        "title": {"type": "string"},
        "status": {"type": "integer"},
        "meaning": {"type": "string"}
    },
    "additionalProperties": false
},
"Position": {
    "description": "x, y, z in the cloud's coordinates",
    "type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3
},
"GridPosition": {
    "description": "Integers; a coordinate is offset + scale × integer",
    "type": "array", "items": {"type": "integer"}, "minItems": 3, "maxItems": 3
},
"Box": {
    "type": "object",
    "required": ["min", "max"],
    "properties": {"min": {"$ref": "#/components/schemas/Position"}, "max": {"$ref": "#/components/schemas/Position"}},
    "additionalProperties": false
},
"Number": {
    "description": "JSON has no number for those that are not finite",
    "anyOf": [{"type": "number"}, {"enum": ["NaN", "Infinity", "-Infinity"]}]
},
"Version": {"type": "string", "description": "Of the cloud's file: another one once it is replaced"},
"NodeKey": {"type": "string", "pattern": "^\\d+-\\d+-\\d+-\\d+$", "description": "level-x-y-z"},
"CloudSummary": {
    "type": "object",
    "required": ["id", "name", "address", "pointCount", "bounds", "sizeBytes", "etag", "version"],
    "properties": {
        "id": {"type": "string"},
        "name": {"type": "string"},
        "address": {"type": "string", "description": "Of its file"},
        "pointCount": {"type": "integer", "minimum": 0},
        "bounds": {
            "description": "Of all points; null if there are none",
            "oneOf": [{"$ref": "#/components/schemas/Box"}, {"type": "null"}]
        },
        "sizeBytes": {"type": "integer", "minimum": 0},
        "etag": {"type": "string", "description": "Of its file"},
        "version": {"$ref": "#/components/schemas/Version"}
    }
},
"CloudList": {
    "type": "object",
    "required": ["clouds"],
    "properties": {
        "clouds": {
            "type": "array",
            "items": {"$ref": "#/components/schemas/CloudSummary", "unevaluatedProperties": false}
        },
        "next": {"type": "string", "description": "Address of what follows; absent on the last page"}
    },
    "additionalProperties": false
},
"Cloud": {
    "$ref": "#/components/schemas/CloudSummary",
    "type": "object",
    "required": ["metadata"],
    "properties": {"metadata": {"$ref": "#/components/schemas/Metadata"}},
    "unevaluatedProperties": false
},
"Metadata": {
    "description": "The metadata of the file as it has them; the specification of the format says more",
    "type": "object",
    "required": ["name", "pointCount", "crs", "grid", "rootCube", "spacing", "pictureColour", "colourIs8Bit",
                 "attributes", "pointHash", "sources", "tool", "options"],
    "properties": {
        "name": {"type": "string"},
        "pointCount": {"type": "integer", "minimum": 0},
        "crs": {"$ref": "#/components/schemas/Crs"},
        "grid": {
            "description": "world = offset + scale × integer",
            "type": "object",
            "required": ["scale", "offset"],
            "properties": {
                "scale": {"$ref": "#/components/schemas/Position"},
                "offset": {"$ref": "#/components/schemas/Position"}
            }
        },
        "rootCube": {
            "description": "2^bits steps of the grid wide, from min",
            "type": "object",
            "required": ["min", "bits"],
            "properties": {
                "min": {"$ref": "#/components/schemas/GridPosition"},
                "bits": {"type": "integer", "minimum": 0, "maximum": 52}
            }
        },
        "spacing": {"$ref": "#/components/schemas/Number"},
        "sampling": {"enum": ["poisson", "random", "grid"], "default": "poisson"},
        "bounds": {
            "description": "Of all points, grid integers; absent if there are none",
            "type": "object",
            "required": ["min", "max"],
            "properties": {
                "min": {"$ref": "#/components/schemas/GridPosition"},
                "max": {"$ref": "#/components/schemas/GridPosition"}
            }
        },
        "pictureColour": {"enum": ["none", "rgb", "intensity"]},
        "innerColour": {"enum": ["exact", "mean"], "default": "exact"},
        "colourIs8Bit": {"type": "boolean", "description": "Red, Green and Blue hold 0 to 255"},
        "attributes": {"type": "array", "items": {"$ref": "#/components/schemas/StoredAttribute"}},
        "pointHash": {"type": "string", "pattern": "^[0-9a-f]{32}$"},
        "sources": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["name", "format", "pointCount", "sizeBytes"],
                "properties": {
                    "name": {"type": "string"},
                    "format": {"type": "string"},
                    "pointCount": {"type": "integer", "minimum": 0},
                    "sizeBytes": {"type": "integer", "minimum": 0}
                }
            }
        },
        "tool": {"type": "string"},
        "options": {"type": "string"}
    }
},
"Crs": {
    "description": "Coordinate reference system; texts are empty where nothing is known",
    "type": "object",
    "required": ["name", "wkt", "proj", "unit", "unitMeters"],
    "properties": {
        "name": {"type": "string"},
        "wkt": {"type": "string"},
        "proj": {"type": "string"},
        "epsg": {"type": "integer"},
        "unit": {"type": "string"},
        "unitMeters": {"type": "number", "description": "0 where unknown or angular"},
        "vertical": {"type": "string"},
        "axes": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["name", "direction", "unit", "unitMeters"],
                "properties": {
                    "name": {"type": "string"},
                    "direction": {"type": "string"},
                    "unit": {"type": "string"},
                    "unitMeters": {"type": "number"}
                }
            }
        }
    }
},
"AttributeType": {
    "enum": ["uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float32", "float64"]
},
"StoredAttribute": {
    "description": "Statistics are of stored values, which mean offset + scale × value",
    "type": "object",
    "required": ["name", "type", "components", "description", "unit", "scale", "offset", "min", "max", "mean",
                 "deviation", "histogram"],
    "properties": {
        "name": {"type": "string"},
        "type": {"$ref": "#/components/schemas/AttributeType"},
        "components": {"type": "integer", "minimum": 1, "maximum": 255},
        "description": {"type": "string"},
        "unit": {"type": "string"},
        "scale": {"$ref": "#/components/schemas/Number"},
        "offset": {"$ref": "#/components/schemas/Number"},
        "noData": {"$ref": "#/components/schemas/Number"},
        "min": {"$ref": "#/components/schemas/Number"},
        "max": {"$ref": "#/components/schemas/Number"},
        "mean": {"$ref": "#/components/schemas/Number"},
        "deviation": {"$ref": "#/components/schemas/Number"},
        "histogram": {
            "description": "Values and how many points have them; empty where there are too many values",
            "type": "array",
            "items": {"type": "array", "items": {"type": "integer"}, "minItems": 2, "maxItems": 2}
        }
    }
}
})json";

} // namespace stipple::server

// The imports of host.hpp: each forwards to `Module.host`, an object of www/src/wasm/host.ts. Views of the
// heap are made here, at the time of the call, and never kept: growing the heap detaches them.
mergeInto(LibraryManager.library, {
    $stippleBytes: function (at, size) {
        return HEAPU8.subarray(at, at + size);
    },

    stippleHostFetch: function (request, url, range) {
        Module['host'].fetch(request, UTF8ToString(url), UTF8ToString(range));
    },
    stippleHostReadFile: function (request, file, offset, size) {
        Module['host'].readFile(request, file, offset, size);
    },
    stippleHostAbort: function (request) {
        Module['host'].abort(request);
    },
    stippleHostCloseFile: function (file) {
        Module['host'].closeFile(file);
    },

    stippleHostDescribeCloud__deps: ['$stippleBytes'],
    stippleHostDescribeCloud: function (cloud, at, size) {
        Module['host'].describeCloud(cloud, stippleBytes(at, size));
    },
    stippleHostForgetCloud: function (cloud) {
        Module['host'].forgetCloud(cloud);
    },
    stippleHostDecode__deps: ['$stippleBytes'],
    stippleHostDecode: function (job, message, messageSize, picture, pictureSize, attributes, attributesSize) {
        Module['host'].decode(job, stippleBytes(message, messageSize), stippleBytes(picture, pictureSize),
            stippleBytes(attributes, attributesSize));
    },

    stippleHostWake: function () {
        Module['host'].wake();
    },

    stippleHostCreateContext__deps: ['$GL'],
    stippleHostCreateContext: function () {
        // Points are drawn into the renderer's own targets; the canvas needs colour only.
        const handle = GL.createContext(Module['canvas'], {
            majorVersion: 2, minorVersion: 0, alpha: false, depth: false, stencil: false, antialias: false,
            powerPreference: 'high-performance', enableExtensionsByDefault: true,
        });
        return handle > 0 && GL.makeContextCurrent(handle);
    },
});

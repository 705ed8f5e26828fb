#include "client/headless/verbs.hpp"

#ifdef HAVE_stipple_converter_verbs
#include "client/headless/http_source.hpp"
#include "converter/verbs/info_verb.hpp"
#endif

namespace stipple {
// Defined by the parts; each adds one subcommand.
#ifdef HAVE_stipple_synth_verbs
void addSynthVerb(CLI::App& program, cli::Action& action);
#endif
#ifdef HAVE_stipple_converter_verbs
void addConvertVerb(CLI::App& program, cli::Action& action);
void addVerifyVerb(CLI::App& program, cli::Action& action);
void addExportVerb(CLI::App& program, cli::Action& action);
#endif
#ifdef HAVE_stipple_server_verbs
void addServeVerb(CLI::App& program, cli::Action& action);
void addViewVerb(CLI::App& program, cli::Action& action);
void addAccessVerb(CLI::App& program, cli::Action& action);
#endif
#ifdef HAVE_stipple_render_verbs
void addRenderVerb(CLI::App& program, cli::Action& action);
#endif
#ifdef HAVE_stipple_bench_verbs
void addBenchVerb(CLI::App& program, cli::Action& action);
#endif
} // namespace stipple

namespace stipple::headless {

#ifdef HAVE_stipple_converter_verbs
namespace {
void addInfo(CLI::App& program, cli::Action& action) {
    addInfoVerb(program, action, openSource);
}
} // namespace
#endif

std::vector<AddVerb> allVerbs() {
    return {
#ifdef HAVE_stipple_synth_verbs
        addSynthVerb,
#endif
#ifdef HAVE_stipple_converter_verbs
        addConvertVerb, addInfo,     addVerifyVerb, addExportVerb,
#endif
#ifdef HAVE_stipple_server_verbs
        addServeVerb,   addViewVerb, addAccessVerb,
#endif
#ifdef HAVE_stipple_render_verbs
        addRenderVerb,
#endif
#ifdef HAVE_stipple_bench_verbs
        addBenchVerb,
#endif
    };
}

} // namespace stipple::headless

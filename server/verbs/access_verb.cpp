// `stipple access`: makes and changes the file that says who may read which cloud.
#include "server/access/access_rules.hpp"
#include "server/access/id_pattern.hpp"
#include "server/access/signed_address.hpp"
#include "server/access/token.hpp"
#include "server/http/target.hpp"
#include "server/site/cloud_address.hpp"
#include "server/verbs/duration.hpp"
#include "shared/base/text.hpp"
#include "shared/cli/verb.hpp"
#include "shared/io/http_date.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

namespace stipple {

namespace {

using namespace server;

struct Options {
    std::string file;
    std::vector<std::string> clouds;
    std::string name, lifetime, token, address;
    bool asJson = false;
};

int usage(const std::string& what) {
    std::fprintf(stderr, "stipple access: %s\n", what.c_str());
    return cli::usageError;
}

// The rules of the file; fresh ones if there is none and `mayBeNew`.
Result<AccessRules> readRules(const Options& options, bool mayBeNew) {
    std::error_code problem;
    if (mayBeNew && !std::filesystem::exists(options.file, problem))
        return freshAccessRules();
    return readAccessFile(options.file);
}

int writeRules(const Options& options, const AccessRules& rules) {
    if (Status status = writeAccessFile(options.file, rules); !status)
        return cli::fail("access", status.error());
    return cli::success;
}

int checkPatterns(const std::vector<std::string>& patterns) {
    for (const std::string& pattern : patterns)
        if (!isIdPattern(pattern))
            return usage(cat("\"", pattern, "\" is no cloud's id, nor one with \"*\" in it"));
    return cli::success;
}

void addOnce(std::vector<std::string>& list, const std::string& pattern) {
    if (std::find(list.begin(), list.end(), pattern) == list.end())
        list.push_back(pattern);
}

// Takes off the list what a pattern covers.
void eraseCovered(std::vector<std::string>& list, const std::string& pattern) {
    std::erase_if(list, [&](const std::string& element) { return matchesPattern(pattern, element); });
}

std::string joined(const std::vector<std::string>& list) {
    std::string text;
    for (const std::string& element : list)
        text += cat(text.empty() ? "" : " ", element);
    return text.empty() ? "none" : text;
}

void printClouds(const AccessRules& rules) {
    std::printf("private: %s\n", joined(rules.privateClouds).c_str());
    if (!rules.publicClouds.empty())
        std::printf("but public: %s\n", joined(rules.publicClouds).c_str());
}

int protect(const Options& options) {
    if (int code = checkPatterns(options.clouds))
        return code;
    auto rules = readRules(options, true);
    if (!rules)
        return cli::fail("access", rules.error());
    for (const std::string& pattern : options.clouds) {
        eraseCovered(rules->publicClouds, pattern);
        addOnce(rules->privateClouds, pattern);
    }
    printClouds(*rules);
    return writeRules(options, *rules);
}

// What is listed as private is taken off the list; where a wider pattern still covers it, it becomes an
// exception.
int unprotect(const Options& options) {
    if (int code = checkPatterns(options.clouds))
        return code;
    auto rules = readRules(options, false);
    if (!rules)
        return cli::fail("access", rules.error());
    for (const std::string& pattern : options.clouds) {
        eraseCovered(rules->privateClouds, pattern);
        if (matchesAny(rules->privateClouds, pattern))
            addOnce(rules->publicClouds, pattern);
    }
    printClouds(*rules);
    return writeRules(options, *rules);
}

int addToken(const Options& options) {
    if (int code = checkPatterns(options.clouds))
        return code;
    std::int64_t now = std::time(nullptr), expires = 0;
    if (!options.lifetime.empty()) {
        auto seconds = parseDuration(options.lifetime);
        if (!seconds)
            return usage("--for takes a number and s, m, h, d or w: 90d");
        expires = now + *seconds;
    }
    auto rules = readRules(options, true);
    if (!rules)
        return cli::fail("access", rules.error());
    auto token = makeToken(*rules, options.name, options.clouds, now, expires);
    if (!token)
        return cli::fail("access", token.error());
    rules->tokens.push_back(token->rule);
    if (int code = writeRules(options, *rules))
        return code;
    std::printf("%s\n", token->text.c_str());
    std::fprintf(stderr, "This is the only time that the token is shown. It has the id %s.\n",
                 token->rule.id.c_str());
    return cli::success;
}

int removeToken(const Options& options) {
    auto rules = readRules(options, false);
    if (!rules)
        return cli::fail("access", rules.error());
    auto isMeant = [&](const TokenRule& rule) {
        return rule.id == options.token || rule.name == options.token;
    };
    auto count = std::erase_if(rules->tokens, isMeant);
    if (count == 0)
        return cli::fail("access",
                         {ErrorCode::notFound, cat("there is no token of the id or name ", options.token),
                          options.file, "`stipple access list` shows them"});
    return writeRules(options, *rules);
}

std::string expiryText(const TokenRule& rule) {
    if (rule.expiresSeconds == 0)
        return "never expires";
    return cat(rule.isExpired(std::time(nullptr)) ? "EXPIRED " : "expires ", httpDate(rule.expiresSeconds));
}

int list(const Options& options) {
    auto rules = readRules(options, false);
    if (!rules)
        return cli::fail("access", rules.error());
    if (options.asJson) {
        nlohmann::ordered_json tokens = nlohmann::ordered_json::array();
        for (const TokenRule& rule : rules->tokens)
            tokens.push_back({{"id", rule.id},
                              {"name", rule.name},
                              {"clouds", rule.clouds},
                              {"created", rule.createdSeconds},
                              {"expires", rule.expiresSeconds}});
        nlohmann::ordered_json json{{"private", rules->privateClouds},
                                    {"public", rules->publicClouds},
                                    {"tokens", std::move(tokens)}};
        std::printf("%s\n",
                    json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
        return cli::success;
    }
    printClouds(*rules);
    for (const TokenRule& rule : rules->tokens)
        std::printf("token %s  %s  for %s, %s\n", rule.id.c_str(),
                    rule.name.empty() ? "-" : rule.name.c_str(), joined(rule.clouds).c_str(),
                    expiryText(rule).c_str());
    return cli::success;
}

// An id, or an address of the cloud: "/clouds/town.stipple",
// "https://host/api/v1/clouds/town/image?width=800".
Result<std::string> signedAddress(const AccessRules& rules, const std::string& address,
                                  std::int64_t expires) {
    std::string whole =
        isIdPattern(address) && address.find('*') == std::string::npos ? cloudAddress(address) : address;
    STIPPLE_TRY(target, parseTarget(whole));
    auto id = cloudIdOf(target);
    if (!id)
        return Error{ErrorCode::invalidArgument, "is neither the id of a cloud nor an address of one",
                     address, "such as town, /clouds/town.stipple or https://example.org/api/v1/clouds/town"};
    std::string rest = withoutSignature(target.query);
    std::string path = whole.substr(0, whole.find('?'));
    return cat(path, "?", rest, rest.empty() ? "" : "&", signedQuery(rules.signingKey, *id, expires));
}

int sign(const Options& options) {
    auto seconds = parseDuration(options.lifetime);
    if (!seconds)
        return usage("--for takes a number and s, m, h, d or w: 7d");
    auto rules = readRules(options, false);
    if (!rules)
        return cli::fail("access", rules.error());
    auto address = signedAddress(*rules, options.address, std::time(nullptr) + *seconds);
    if (!address)
        return usage(address.error().sentence());
    std::printf("%s\n", address->c_str());
    return cli::success;
}

int newKey(const Options& options) {
    auto rules = readRules(options, false);
    if (!rules)
        return cli::fail("access", rules.error());
    auto fresh = freshAccessRules();
    if (!fresh)
        return cli::fail("access", fresh.error());
    rules->signingKey = fresh->signingKey;
    return writeRules(options, *rules);
}

} // namespace

void addAccessVerb(CLI::App& program, cli::Action& action) {
    auto options = std::make_shared<Options>();
    CLI::App* verb = program.add_subcommand("access", "Say who may read which cloud of a server");
    verb->require_subcommand(1);
    auto add = [&](const char* name, const char* description, int (*run)(const Options&)) {
        CLI::App* command = verb->add_subcommand(name, description);
        command->add_option("FILE", options->file, "The access file, as for `stipple serve --access`")
            ->required();
        command->callback([options, run, &action] { action = [options, run] { return run(*options); }; });
        return command;
    };
    const char* clouds = "Ids of clouds; \"*\" stands for any characters: \"survey-*\"";
    add("protect", "Make clouds private (makes the file if there is none)", protect)
        ->add_option("CLOUD", options->clouds, clouds)
        ->required();
    add("unprotect", "Make clouds public again", unprotect)
        ->add_option("CLOUD", options->clouds, clouds)
        ->required();
    CLI::App* token = add("add", "Make a token and print it, this once", addToken);
    token->add_option("CLOUD", options->clouds, clouds)->required();
    token->add_option("--name", options->name, "Who it is for; shown by `list`");
    token->add_option("--for", options->lifetime, "How long it holds: 90d, 12h; for ever if not given");
    add("remove", "End a token", removeToken)
        ->add_option("TOKEN", options->token, "Its id or name")
        ->required();
    add("list", "Show what is private and which tokens there are", list)
        ->add_flag("--json", options->asJson, "As one line of JSON");
    CLI::App* signing =
        add("sign", "Print an address that opens a private cloud for a while, without a token", sign);
    signing->add_option("ADDRESS", options->address, "Id of a cloud, or an address of it")->required();
    signing->add_option("--for", options->lifetime, "How long it holds: 7d, 12h, 30m")->required();
    add("new-key", "Make a new key: every signed address ends", newKey);
    verb->footer(
        "A server takes changes over on SIGHUP.\n"
        "Example: stipple access protect access.json \"survey-*\"\n"
        "         stipple access add access.json \"survey-*\" --name Lisa --for 90d\n"
        "         stipple access sign access.json https://example.org/clouds/survey-1.stipple --for 7d");
}

} // namespace stipple

// The Test Explorer: unit tests and tables, as `staunch test` runs and reports them. Which exist is known from a run; those that are
// written as TEST '…' are listed before.

const path = require("node:path");
const vscode = require("vscode");
const command = require("./command");

const SOURCES = "**/*.{st,iecst,TcPOU,scl}";
const TITLE = /^[ \t]*TEST[ \t]+(?:'([^'\n]*)'|"([^"\n]*)")/gim;
// TcUnit's suites, and AxUnit's.
const SUITE = /\bTEST_FINISHED|\{\s*Test(?:Fixture)?\b/i;

function tests(context) {
    const controller = vscode.tests.createTestController("staunch", "Staunch");
    context.subscriptions.push(controller);

    // What is run together: a project, or a folder.
    async function root(folder) {
        const project = await command.project(folder);
        const at = project ?? folder;
        const found = controller.items.get(at);
        if (found) return found;
        const item = controller.createTestItem(at, vscode.workspace.asRelativePath(at), vscode.Uri.file(at));
        item.description = project ? "staunch.toml" : undefined;
        controller.items.add(item);
        return item;
    }

    function test(parent, file, title, line) {
        const id = `${file}\n${title}`;
        let item = parent.children.get(id);
        if (!item) {
            item = controller.createTestItem(id, title, vscode.Uri.file(file));
            parent.children.add(item);
        }
        item.range = new vscode.Range(line, 0, line, 0);
        return item;
    }

    async function discover(uri) {
        const text = await vscode.workspace.fs.readFile(uri).then((it) => new TextDecoder().decode(it), () => undefined);
        const found = [...(text ?? "").matchAll(TITLE)];
        const isSuite = SUITE.test(text ?? "");
        if (found.length === 0 && !isSuite) return forget(uri, new Set());
        const parent = await root(path.dirname(uri.fsPath));
        const kept = new Set();
        for (const match of found) {
            const line = text.slice(0, match.index).split("\n").length - 1;
            kept.add(test(parent, uri.fsPath, match[1] ?? match[2], line).id);
        }
        if (!isSuite) forget(uri, kept);
    }

    // Tests of a file that are not in it any more.
    function forget(uri, kept) {
        controller.items.forEach((parent) => {
            const gone = [];
            parent.children.forEach((it) => {
                if (it.uri.fsPath === uri.fsPath && !kept.has(it.id)) gone.push(it.id);
            });
            gone.forEach((it) => parent.children.delete(it));
            if (gone.length > 0 && parent.children.size === 0) controller.items.delete(parent.id);
        });
    }

    async function discoverAll() {
        const files = await vscode.workspace.findFiles(SOURCES);
        for (const uri of files) await discover(uri);
        // A table next to its source: `pump.csv` with a column `|`.
        for (const uri of await vscode.workspace.findFiles("**/*.csv")) {
            const source = uri.fsPath.replace(/\.csv$/i, ".st");
            const text = new TextDecoder().decode(await vscode.workspace.fs.readFile(uri));
            const [header] = text.split("\n", 1);
            if (/(^|[,;])\s*\|\s*([,;]|$)/.test(header) && (await command.exists(source))) await root(path.dirname(source));
        }
    }
    controller.resolveHandler = (item) => (item ? undefined : discoverAll());
    controller.refreshHandler = discoverAll;
    const watcher = vscode.workspace.createFileSystemWatcher(SOURCES);
    watcher.onDidCreate(discover);
    watcher.onDidChange(discover);
    watcher.onDidDelete((uri) => forget(uri, new Set()));
    context.subscriptions.push(watcher);

    async function run(request, token) {
        const made = controller.createTestRun(request);
        if (!vscode.workspace.isTrusted) {
            made.appendOutput("The folder is not trusted: its programs do not run.\r\n");
            return made.end();
        }
        const all = [];
        controller.items.forEach((it) => all.push(it));
        const chosen = request.include ?? all;
        // A whole project stands for its tests.
        for (const item of chosen.filter((it) => !it.parent)) await runOne(made, item, undefined, token);
        const single = chosen.filter((it) => it.parent && !chosen.includes(it.parent));
        for (const item of single) await runOne(made, item.parent, item, token);
        made.end();
    }

    // A project's tests, or one of them.
    async function runOne(made, parent, only, token) {
        const waiting = new Set();
        if (only) waiting.add(only);
        else parent.children.forEach((it) => waiting.add(it));
        waiting.forEach((it) => made.started(it));
        const isProject = (await command.project(parent.id)) === parent.id;
        const args = ["test", ...(isProject ? [] : ["."]), "--message-format", "json", ...command.common(parent.uri)];
        if (only) args.push(`--filter=${only.label}`);
        const problems = [];
        const line = (text) => {
            const found = object(text);
            if (found?.reason !== "test") {
                if (found && found.reason !== "tests") problems.push(found.rendered ?? found.message ?? text);
                return;
            }
            const file = path.resolve(parent.id, found.file);
            const item = test(parent, file, found.title, Math.max(0, (found.line ?? 1) - 1));
            // The filter is a part of a title: others may have it, too.
            if (only && item !== only) return;
            waiting.delete(item);
            const said = [`${found.result.padEnd(8)}${found.title}`, found.message].filter(Boolean).join("\n");
            made.appendOutput(`${said}\n`.replace(/\r?\n/g, "\r\n"), undefined, item);
            report(made, item, found);
        };
        try {
            const { err } = await command.run(parent.uri, args, { cwd: parent.id, token, line });
            const said = [...problems, err].filter(Boolean).join("\n");
            made.appendOutput(said.replace(/\r?\n/g, "\r\n"));
            const message = new vscode.TestMessage(said || "It was not run.");
            if (token.isCancellationRequested) waiting.forEach((it) => made.skipped(it));
            else waiting.forEach((it) => made.errored(it, message));
            if (problems.length > 0 && waiting.size === 0) made.errored(parent, message);
        } catch (error) {
            waiting.forEach((it) => made.errored(it, new vscode.TestMessage(error.message)));
            void command.missing(parent.uri, error);
        }
    }

    function report(made, item, found) {
        if (found.result === "passed") return made.passed(item);
        if (found.result === "skipped") return made.skipped(item);
        const message = new vscode.TestMessage(found.message || "failed");
        // `blower.st:17:5: …`, where it failed.
        const at = /^(.+?):(\d+):(\d+): /m.exec(found.message ?? "");
        message.location = at
            ? new vscode.Location(vscode.Uri.file(path.resolve(item.parent.id, at[1])), new vscode.Position(at[2] - 1, at[3] - 1))
            : new vscode.Location(item.uri, item.range);
        made.failed(item, message);
    }

    controller.createRunProfile("Run", vscode.TestRunProfileKind.Run, run, true);
}

function object(text) {
    try {
        return JSON.parse(text);
    } catch {
        return undefined;
    }
}

module.exports = { tests };

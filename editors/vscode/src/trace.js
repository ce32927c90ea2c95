// Runs a program with the stimulus next to it, and shows the trace.

const fs = require("node:fs/promises");
const os = require("node:os");
const path = require("node:path");
const vscode = require("vscode");
const command = require("./command");

const NONE = "Without a stimulus: 100 scans";

// The stimulus of a file: `pump.csv` or `stimulus.csv` next to it; where neither exists, a choice of the folder's tables.
async function stimulus(file) {
    const folder = path.dirname(file);
    const tables = (await fs.readdir(folder)).filter((it) => /\.csv$/i.test(it)).sort();
    const own = [`${path.parse(file).name}.csv`, `${path.basename(file)}.csv`, "stimulus.csv"].find((it) => tables.includes(it));
    if (own) return own;
    if (tables.length === 0) return NONE;
    return vscode.window.showQuickPick([...tables, NONE], { placeHolder: "The stimulus" });
}

async function showTrace(context, uri) {
    const document = vscode.window.activeTextEditor?.document;
    const source = uri ?? document?.uri;
    if (source?.scheme !== "file") return;
    await vscode.workspace.textDocuments.find((it) => it.uri.toString() === source.toString())?.save();
    const file = source.fsPath;
    const chosen = await stimulus(file);
    if (chosen === undefined) return;
    const folder = path.dirname(file);
    const project = await command.project(folder);
    const given = chosen === NONE ? ["--scans", "100"] : ["--stimulus", path.join(folder, chosen)];
    const scratch = await fs.mkdtemp(path.join(os.tmpdir(), "staunch-"));
    const page = path.join(scratch, "trace.html");
    const args = ["run", "-q", ...(project ? [] : [file]), ...given, "--trace", page, ...command.common(source)];
    try {
        const progress = { location: vscode.ProgressLocation.Notification, title: "Staunch: the program runs", cancellable: true };
        const result = await vscode.window.withProgress(progress, (_, token) =>
            command.run(source, args, { cwd: project ?? folder, token }),
        );
        const html = await fs.readFile(page, "utf8").catch(() => undefined);
        // A fault ends a run, and leaves the trace up to it.
        if (result.code !== 0) {
            channel(context).replace(`staunch ${args.join(" ")}\n\n${result.err}`);
            void vscode.window
                .showErrorMessage(`Staunch: ${result.err.split("\n").find(Boolean) ?? "the run was ended"}`, "Show all")
                .then((it) => it && channel(context).show());
        }
        if (html !== undefined) show(context, `${path.basename(file)}: ${chosen === NONE ? "100 scans" : chosen}`, html);
    } catch (error) {
        void command.missing(source, error);
    } finally {
        await fs.rm(scratch, { recursive: true, force: true });
    }
}

let output;
function channel(context) {
    if (!output) context.subscriptions.push((output = vscode.window.createOutputChannel("Staunch: run")));
    return output;
}

// One panel a title: a second run replaces what it shows.
const panels = new Map();
function show(context, title, html) {
    let panel = panels.get(title);
    if (panel) {
        panel.reveal();
    } else {
        // Not next to the source: names and values take much of a narrow page.
        const where = vscode.ViewColumn.Active;
        panel = vscode.window.createWebviewPanel("staunch.trace", title, where, { enableScripts: true, retainContextWhenHidden: true });
        panel.onDidDispose(() => panels.delete(title));
        panels.set(title, panel);
        context.subscriptions.push(panel);
    }
    panel.webview.html = html;
}

module.exports = { showTrace };

// The command `staunch`: how it is called, and for which files.

const { spawn } = require("node:child_process");
const fs = require("node:fs/promises");
const path = require("node:path");
const vscode = require("vscode");

function settings(uri) {
    return vscode.workspace.getConfiguration("staunch", uri);
}

// A path that begins with `.` or `~`, or names the folder, as settings are shared between machines.
function executable(uri) {
    const given = settings(uri).get("path") || "staunch";
    const folder = (uri && vscode.workspace.getWorkspaceFolder(uri)) || vscode.workspace.workspaceFolders?.[0];
    const named = given.replace("${workspaceFolder}", folder?.uri.fsPath ?? "").replace(/^~(?=[\\/])/, require("node:os").homedir());
    return /[\\/]/.test(named) && !path.isAbsolute(named) && folder ? path.join(folder.uri.fsPath, named) : named;
}

// Options that all commands take.
function common(uri) {
    const dialect = settings(uri).get("dialect");
    return dialect ? ["--dialect", dialect] : [];
}

// Runs a command; each line of standard output is passed on as it comes.
function run(uri, args, { cwd, token, line } = {}) {
    return new Promise((resolve, reject) => {
        const child = spawn(executable(uri), args, { cwd, env: { ...process.env, NO_COLOR: "1" } });
        let out = "";
        let rest = "";
        let err = "";
        child.stdout.setEncoding("utf8").on("data", (text) => {
            out += text;
            const lines = (rest + text).split(/\r?\n/);
            rest = lines.pop();
            if (line) lines.forEach(line);
        });
        child.stderr.setEncoding("utf8").on("data", (text) => (err += text));
        child.on("error", reject);
        child.on("close", (code) => {
            if (line && rest) line(rest);
            resolve({ code, out, err });
        });
        token?.onCancellationRequested(() => child.kill());
    });
}

async function exists(file) {
    return fs.access(file).then(() => true, () => false);
}

// The folder of the nearest `staunch.toml` that lists files, for commands without a FILE; nothing where none does.
async function project(folder) {
    for (let at = folder; ; at = path.dirname(at)) {
        const text = await fs.readFile(path.join(at, "staunch.toml"), "utf8").catch(() => "");
        if (/^\s*files\s*=/m.test(text)) return at;
        if (path.dirname(at) === at) return undefined;
    }
}

// Says that the command cannot be started, and where it is set.
async function missing(uri, error) {
    const choice = await vscode.window.showErrorMessage(
        `Staunch: \`${executable(uri)}\` cannot be started: ${error.message}. Install the command, or set its path.`,
        "Open settings",
    );
    if (choice) await vscode.commands.executeCommand("workbench.action.openSettings", "staunch.path");
}

module.exports = { common, executable, exists, missing, project, run, settings };

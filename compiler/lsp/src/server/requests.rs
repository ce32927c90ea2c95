//! Each request with what answers it, and what has to be known for that.

use super::{Refused, Server};
use crate::answers::{
    actions, complete, declare, dialects, folds, hierarchy, hints, layout, lenses, navigate, rename, select, signature,
    symbols, tokens,
};
use crate::place::Place;
use crate::project::{self, Analysis};
use crate::uri;
use gen_lsp_types::{
    CodeActionParams, DocumentDiagnosticReport, DocumentRangeFormattingParams, ExecuteCommandParams,
    FullDocumentDiagnosticReport, InlayHintParams, LspRequestMethod, Position, RelatedFullDocumentDiagnosticReport,
    RenameParams, SelectionRangeParams, SemanticTokens, TextDocumentIdentifier, TextDocumentPositionParams, Uri,
    WorkspaceSymbolParams,
};
use lsp_server::ErrorCode;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value as Json;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub(super) type Answer = Result<Json, Refused>;

/// Whether a request is answered when the program has been checked; else it is answered at once.
pub(super) fn needs_check(method: &LspRequestMethod<'_>) -> bool {
    use LspRequestMethod as Method;
    matches!(
        method,
        Method::TextDocumentReferences
            | Method::TextDocumentDocumentHighlight
            | Method::CallHierarchyIncomingCalls
            | Method::CallHierarchyOutgoingCalls
            | Method::TextDocumentSemanticTokensFull
            | Method::TextDocumentInlayHint
            | Method::TextDocumentCodeAction
            | Method::TextDocumentRename
            | Method::TextDocumentDiagnostic
    )
}

impl Server<'_> {
    pub(super) fn answer(&mut self, method: LspRequestMethod<'_>, params: Json) -> Answer {
        use LspRequestMethod as Method;
        match method {
            Method::TextDocumentHover => self.at(params, navigate::hover),
            Method::TextDocumentDefinition => self.at(params, navigate::definition),
            Method::TextDocumentTypeDefinition => self.at(params, navigate::type_definition),
            Method::TextDocumentImplementation => {
                self.at(params, |it, place| Some(navigate::implementations(it, place)))
            }
            Method::TextDocumentReferences => {
                let with_declaration = params["context"]["includeDeclaration"].as_bool().unwrap_or(true);
                self.at(params, |it, place| Some(navigate::references(it, place, with_declaration)))
            }
            Method::TextDocumentDocumentHighlight => self.at(params, |it, place| Some(navigate::highlights(it, place))),
            Method::TextDocumentSignatureHelp => self.signature(params),
            Method::TextDocumentPrepareCallHierarchy => {
                self.at(params, |it, place| hierarchy::prepare_calls(it, place).map(|it| vec![it]))
            }
            Method::TextDocumentPrepareTypeHierarchy => {
                self.at(params, |it, place| hierarchy::prepare_types(it, place).map(|it| vec![it]))
            }
            Method::CallHierarchyIncomingCalls => {
                self.of_item(&params, |it, place| Some(hierarchy::incoming(it, place)))
            }
            Method::CallHierarchyOutgoingCalls => {
                self.of_item(&params, |it, place| Some(hierarchy::outgoing(it, place)))
            }
            Method::TypeHierarchySupertypes => {
                self.of_item(&params, |it, place| Some(hierarchy::supertypes(it, place)))
            }
            Method::TypeHierarchySubtypes => self.of_item(&params, |it, place| Some(hierarchy::subtypes(it, place))),
            Method::TextDocumentDocumentSymbol => {
                let (analysis, file) = self.outline(&params)?;
                json(symbols::outline(&analysis, file))
            }
            Method::TextDocumentCodeLens => {
                let (path, project) = self.document(&params)?;
                let (analysis, file) = self.outline(&params)?;
                json(lenses::lenses(&analysis, file, &uri::of(&path), &self.projects[project].results))
            }
            Method::WorkspaceExecuteCommand => {
                let params: ExecuteCommandParams = read(params)?;
                self.execute(&params.command, params.arguments.unwrap_or_default())
            }
            Method::TextDocumentFoldingRange => {
                let (path, project) = self.document(&params)?;
                let project = &mut self.projects[project];
                let sources = project.sources(&self.documents);
                json(project.file(&path).map(|it| folds::folds(sources.get(it), it)))
            }
            Method::TextDocumentSelectionRange => {
                let positions = read::<SelectionRangeParams>(params.clone())?.positions;
                let (analysis, file) = self.outline(&params)?;
                let around = |it: Position| select::around(&analysis, project::place(&analysis.sources, file, it)?);
                json(positions.into_iter().map(around).collect::<Option<Vec<_>>>())
            }
            Method::TextDocumentSemanticTokensFull => {
                self.file(&params, |it, file| SemanticTokens { result_id: None, data: tokens::tokens(it, file) })
            }
            Method::TextDocumentInlayHint => {
                let within = read::<InlayHintParams>(params.clone())?.range;
                self.file(&params, |it, file| hints::hints(it, file, within))
            }
            Method::TextDocumentCodeAction => {
                let within = read::<CodeActionParams>(params.clone())?.range;
                let (path, project) = self.document(&params)?;
                let analysis = self.whole(project);
                let project = &self.projects[project];
                let Some(file) = project.file(&path) else { return Ok(Json::Null) };
                let mut found = actions::actions(&analysis, file, within);
                found.extend(declare::actions(&analysis, file, within));
                if let Some(choice) = project.unit.choice.as_ref().filter(|it| it.has_settings || self.can_create)
                    && actions::has_errors(&analysis, file, within)
                {
                    found.extend(project.dialects.iter().map(|it| dialects::choose(choice, *it)));
                }
                json(found)
            }
            Method::TextDocumentCompletion => {
                let position = read::<TextDocumentPositionParams>(params.clone())?.position;
                let (path, project) = self.document(&params)?;
                json(complete::complete(&mut self.projects[project], &self.documents, &path, position))
            }
            Method::TextDocumentPrepareRename => {
                let position = read::<TextDocumentPositionParams>(params.clone())?.position;
                let (path, project) = self.document(&params)?;
                let found = self.near(project, &path, position);
                let (analysis, place) = found.ok_or_else(|| "there is no name here".to_owned())?;
                json(rename::prepare(&analysis, place)?)
            }
            Method::TextDocumentRename => {
                let (path, project) = self.document(&params)?;
                let params: RenameParams = read(params)?;
                let position = params.text_document_position_params.position;
                let found = self.near(project, &path, position);
                let (analysis, place) = found.ok_or_else(|| "there is no name here".to_owned())?;
                let project = &mut self.projects[project];
                json(rename::rename(project, &analysis, &self.documents, place, &params.new_name)?)
            }
            Method::TextDocumentFormatting => {
                let (path, project) = self.document(&params)?;
                let text = self.documents.get(&path).cloned().unwrap_or_default();
                let layout = &self.projects[project].unit.layout;
                json(layout::whole(&path.to_string_lossy(), &text, layout))
            }
            Method::TextDocumentRangeFormatting => {
                let within = read::<DocumentRangeFormattingParams>(params.clone())?.range;
                let (path, project) = self.document(&params)?;
                let text = self.documents.get(&path).cloned().unwrap_or_default();
                let layout = &self.projects[project].unit.layout;
                json(layout::part(&path.to_string_lossy(), &text, layout, within))
            }
            Method::TextDocumentDiagnostic => {
                let path = self.path(&params)?;
                let items = self.problems(&path);
                let full = FullDocumentDiagnosticReport { result_id: None, items };
                let report = RelatedFullDocumentDiagnosticReport {
                    full_document_diagnostic_report: full,
                    ..RelatedFullDocumentDiagnosticReport::default()
                };
                json(DocumentDiagnosticReport::RelatedFullDocumentDiagnosticReport(report))
            }
            Method::WorkspaceSymbol => {
                let query = read::<WorkspaceSymbolParams>(params)?.query;
                let all = (0..self.projects.len()).flat_map(|it| {
                    let analysis = self.declared(it);
                    symbols::workspace(&analysis, &query)
                });
                json(all.collect::<Vec<_>>())
            }
            other => Err(Refused::new(ErrorCode::MethodNotFound, format!("{other} is not supported"))),
        }
    }

    /// The file that a request is about.
    pub(super) fn path(&self, params: &Json) -> Result<PathBuf, Refused> {
        // An item of a hierarchy is what an earlier answer named.
        let document = if params["item"].is_object() { &params["item"] } else { &params["textDocument"] };
        let document: TextDocumentIdentifier = read(document.clone())?;
        path(&document.uri)
    }

    /// The same, and its project.
    fn document(&mut self, params: &Json) -> Result<(PathBuf, usize), Refused> {
        let path = self.path(params)?;
        let project = self.project_of(&path)?;
        Ok((path, project))
    }

    /// What all files of a project declare.
    fn declared(&mut self, project: usize) -> Arc<Analysis> {
        let project = &mut self.projects[project];
        if let Some(known) = project.known() {
            return Arc::clone(known);
        }
        let sources = project.sources(&self.documents);
        let files = 0..crate::place::count(sources.files().len()).try_into().unwrap_or(u16::MAX);
        Arc::new(Analysis::outline(&project.unit, sources, files))
    }

    /// What a file declares, and its number.
    fn outline(&mut self, params: &Json) -> Result<(Analysis, u16), Refused> {
        let (path, project) = self.document(params)?;
        let project = &mut self.projects[project];
        let file = project.file(&path).ok_or_else(|| format!("{} is not a source", path.display()))?;
        let sources = project.sources(&self.documents);
        Ok((Analysis::outline(&project.unit, sources, file..file + 1), file))
    }

    fn file<T: Serialize>(&mut self, params: &Json, answer: impl FnOnce(&Analysis, u16) -> T) -> Answer {
        let (path, project) = self.document(params)?;
        let analysis = self.whole(project);
        json(self.projects[project].file(&path).map(|it| answer(&analysis, it)))
    }

    fn at<T: Serialize>(&mut self, params: Json, answer: impl FnOnce(&Analysis, Place) -> Option<T>) -> Answer {
        let path = self.path(&params)?;
        let position = read::<TextDocumentPositionParams>(params)?.position;
        self.at_position(&path, position, answer)
    }

    /// What a call takes, also while it is typed.
    fn signature(&mut self, params: Json) -> Answer {
        let path = self.path(&params)?;
        let position = read::<TextDocumentPositionParams>(params)?.position;
        let project = self.project_of(&path)?;
        let Some((analysis, place)) = self.near(project, &path, position) else { return json(None::<()>) };
        if let Some(help) = signature::help(&analysis, place) {
            return json(Some(help));
        }
        let text = signature::closed(&analysis, place).filter(|_| !analysis.source(place.file).is_assembled());
        let closed = text.map(|text| self.projects[project].around_in(&self.documents, place, &text));
        json(closed.and_then(|it| signature::help_by(&analysis, &it, place)))
    }

    /// The same for what an earlier answer named.
    fn of_item<T: Serialize>(&mut self, params: &Json, answer: impl FnOnce(&Analysis, Place) -> Option<T>) -> Answer {
        let position: Position = read(params["item"]["selectionRange"]["start"].clone())?;
        self.at_position(&self.path(params)?, position, answer)
    }

    fn at_position<T: Serialize>(
        &mut self,
        path: &Path,
        position: Position,
        answer: impl FnOnce(&Analysis, Place) -> Option<T>,
    ) -> Answer {
        let project = self.project_of(path)?;
        json(self.near(project, path, position).and_then(|(analysis, place)| answer(&analysis, place)))
    }

    /// A place with what is known of the names around it.
    fn near(&mut self, project: usize, path: &Path, position: Position) -> Option<(Arc<Analysis>, Place)> {
        let project = &mut self.projects[project];
        let sources = project.sources(&self.documents);
        let place = project::place(&sources, project.file(path)?, position)?;
        Some((project.near(&self.documents, place), place))
    }
}

pub(super) fn path(uri: &Uri) -> Result<PathBuf, Refused> {
    uri::path(uri).ok_or_else(|| Refused::new(ErrorCode::InvalidParams, format!("{uri} is not a file")))
}

pub(super) fn read<T: DeserializeOwned>(params: Json) -> Result<T, Refused> {
    serde_json::from_value(params).map_err(|it| Refused::new(ErrorCode::InvalidParams, it.to_string()))
}

fn json(value: impl Serialize) -> Answer {
    serde_json::to_value(value).map_err(|it| Refused::new(ErrorCode::InternalError, it.to_string()))
}
